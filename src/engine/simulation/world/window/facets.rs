//! Facets of rough ground under rocks among others: the mesh is rotated for such a rock, as the others
//! meet it with its true motion (`solver::tilted_mesh`).

use super::super::WorldBody;
use super::IslandWindow;
use crate::rock::{Motion, Vec3};
use crate::simulation::settings::RunSettings;
use crate::solver::island::Island;

impl<'a> IslandWindow<'a> {
    /// Rotates the mesh in place of the motion of rocks that are on a facet among others, and drops
    /// the offsets that facets have left.
    pub(super) fn rotate_meshes(&mut self, island: &mut Island<'a>) {
        for k in 0..island.members.len() {
            let facets = &island.members[k].state.facets;
            if !facets.is_tilted() && !facets.has_rotated_mesh() {
                continue;
            }
            if island.members.len() == 1 {
                self.with_rock(island, k, WorldBody::rotate_motion);
                continue;
            }
            let longer = longer_impact(island, k);
            self.with_rock(island, k, |rock, settings| rock.rotate_mesh(settings, longer));
            if !island.members[k].state.is_off_mesh() {
                continue;
            }
            let to = self.with_rock(island, k, WorldBody::without_offset);
            if is_unnoticed(island, k, &to) {
                self.with_rock(island, k, |rock, settings| rock.move_to(settings, to));
            }
        }
    }

    /// Does something with a rock of the island, whose state the solver has.
    pub(super) fn with_rock<T>(
        &mut self,
        island: &mut Island<'a>,
        k: usize,
        act: impl FnOnce(&mut WorldBody<'a>, &RunSettings<'a>) -> T,
    ) -> T {
        let (body, member) = (&mut self.bodies[k], &mut island.members[k]);
        std::mem::swap(&mut body.member, member);
        let done = act(body, self.settings);
        std::mem::swap(&mut body.member, member);
        done
    }
}

/// How many times as long as alone an impact of rock `k` may last (–), as the heaviest of the others
/// presses it on: `ω` goes with `1/√m`.
fn longer_impact(island: &Island, k: usize) -> f64 {
    let masses = island.members.iter().map(|member| member.body.mass);
    (1.0 + masses.fold(0.0, f64::max) / island.members[k].body.mass).sqrt()
}

/// Whether rock `k` may be moved `to` a place (m) without a contact with another rock that begins,
/// ends or is pressed otherwise.
fn is_unnoticed(island: &Island, k: usize, to: &Vec3) -> bool {
    let at = |place: usize| &island.members[place].state.c;
    let from = at(k);
    from == to
        || island.pair_histories.iter().all(|pair| {
            let ends = [pair.a as usize, pair.b as usize];
            let Some(place) = ends.iter().position(|end| *end == k) else { return true };
            let other = ends[1 - place];
            let reach_m = island.members[k].body.radius + island.members[other].body.radius;
            let gap_m = |c: &Vec3| (c - at(other)).norm() - reach_m;
            !pair.is_held() && gap_m(to) >= gap_m(from).min(0.0)
        })
}

impl WorldBody<'_> {
    /// Rotates the mesh in place of the motion, if the rock is on a facet; its impact may last
    /// `longer` times as long as alone (–).
    fn rotate_mesh(&mut self, settings: &RunSettings, longer: f64) {
        let now_s = self.recorder.now.time_s;
        let (world, state) = self.member.with_environment(settings.terrain);
        if let Some(turn) = state.rotate_mesh(&world, now_s, longer) {
            self.recorder.now.turn(&turn);
        }
    }

    /// Rotates the motion in place of the mesh, for a rock that is alone again.
    fn rotate_motion(&mut self, settings: &RunSettings) {
        let (world, state) = self.member.with_environment(settings.terrain);
        if state.facets.has_rotated_mesh() {
            state.rotate_motion(&world);
            self.record_move();
        }
    }

    /// Where the rock could go on without an offset from the mesh (m).
    fn without_offset(&mut self, settings: &RunSettings) -> Vec3 {
        let (world, state) = self.member.with_environment(settings.terrain);
        state.without_offset(&world)
    }

    /// Goes on from another place (m).
    pub(in crate::simulation::world) fn move_to(&mut self, settings: &RunSettings, to: Vec3) {
        let (world, state) = self.member.with_environment(settings.terrain);
        state.move_to(&world, to);
        self.record_move();
    }

    /// Continues the record with the state's own motion.
    fn record_move(&mut self) {
        let state = &self.member.state;
        let now = Motion {
            position_m: state.c,
            velocity_m_s: state.v,
            spin_rad_s: state.w,
            ..self.recorder.now
        };
        self.recorder.record_velocity_jump(now);
        self.update_deviation();
    }
}
