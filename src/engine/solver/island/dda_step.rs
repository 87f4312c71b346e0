//! Scheme `dda` for an island: the paper's step at a fixed time step, open–close iteration over all contacts.
//!
//! For each rock the six unknowns of a step are the displacement and the rotation of its centre, paper Eq. (1). With
//! the step `Δt` given, inertia and weight alone would move it by the free displacement; contacts add springs and
//! loads to the system of 6×6 blocks, paper Eq. (4). Which contacts are closed and which of them slip is not known
//! before the step: the system is solved, each contact is judged at the displacements found, and it is solved again
//! until no contact changes (open–close iteration).
//!
//! Displacements are kept in two parts, `ways[0]` of the free motion and `ways[1]` of the contacts. The velocity at
//! the end comes from `ways[1]` alone, `v + g Δt + 2 d/Δt` of the constant-acceleration step, so that rounding of the
//! free motion never enters it.

use super::assembly::Island;
use super::body::IslandBody;
use super::dda_contact::DdaPairContact;
use super::outcome::Done;
use crate::contact::ContactPoint;
use crate::contact::submatrix::Vec6;
use crate::rock::Vec3;
use crate::solver::Settings;
use crate::solver::contact_state::ContactEnvironment;
use crate::solver::dda::{DEEPEST, compliance, free_motion, knows};
use crate::solver::dda_system::contact::{DdaContact, StepConstants};
use crate::solver::dda_system::slider::Change;
use crate::solver::dda_system::{ROUNDS, SOLVES};
use crate::solver::loss::{Given, Loss};
use crate::solver::step_control::StepError;
use crate::terrain::Terrain;

impl Island<'_> {
    /// One step of the scheme `dda`, at most `h_max` (s) long.
    ///
    /// # Errors
    /// [`StepError`] if a rock sank in or its motion is no longer finite.
    pub fn advance_fixed(&mut self, settings: &Settings, h_max: f64) -> Result<Done, StepError> {
        // the fixed step, cut only at events and where a rock would pass what has been looked for
        let dt = settings.step_s.min(h_max).min(self.travel_limit());
        let memory = settings.shear_memory;
        let terrain = self.terrain;
        let before: Vec<Loss> =
            self.members.iter_mut().map(|member| member.meet(terrain, (dt, memory))).collect();
        let mut links = self.links(dt, memory);
        // a system that cannot be factored means a motion that is no number: the rocks end as failed
        let settled = self.solve_fixed(&mut links, (dt, memory)).ok_or(StepError::NotFinite)?;
        let mut done = Done { dt, unsettled: !settled, ..Done::default() };
        for (member, before) in self.members.iter_mut().zip(before) {
            done.losses.push(member.carry_on(terrain, dt, &before)?);
            done.given.push(Given::default());
        }
        self.remember(&links, &mut done)?;
        Ok(done)
    }

    /// Contacts between rocks that are closed or may close within the step; the slack is a tenth of the smaller
    /// radius.
    fn links(&self, dt: f64, memory: bool) -> Vec<DdaPairContact> {
        let over = |(k, pair_history): (usize, &crate::contact::pair::PairHistory)| {
            let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.members[k as usize]);
            let slack = 0.1 * a.body.radius.min(b.body.radius);
            let at = [&a.state.c, &b.state.c];
            DdaPairContact::over((k, pair_history), [&a.body, &b.body], at, slack, (dt, memory))
        };
        self.pair_histories.iter().enumerate().filter_map(over).collect()
    }

    /// Solves the step, and again with the contacts that it ran into; whether the contact states settled.
    /// Ends, because a rock keeps no more than `MOST` contacts and each round adds one.
    fn solve_fixed(
        &mut self,
        links: &mut [DdaPairContact],
        (dt, memory): (f64, bool),
    ) -> Option<bool> {
        loop {
            let settled = self.settle_fixed(links, dt)?;
            let mut more = false;
            for member in &mut self.members {
                more |= member.meet_more(self.terrain, (dt, memory));
            }
            if !more {
                return Some(settled);
            }
        }
    }

    /// Open–close iteration; a step that does not settle is solved with all contacts sticking.
    /// The same limits as for a rock alone (`dda_system`): six changes of state, forty solves.
    fn settle_fixed(&mut self, links: &mut [DdaPairContact], dt: f64) -> Option<bool> {
        let mut rounds = 0;
        for _ in 0..SOLVES {
            self.sweeps += 1;
            self.solve_once(links, dt)?;
            match self.judge(links) {
                Change::None => return Some(true),
                Change::Load => {}
                Change::Mode => rounds += 1,
            }
            if rounds == ROUNDS {
                break;
            }
        }
        for member in &mut self.members {
            member.joints.iter_mut().for_each(DdaContact::stick);
        }
        links.iter_mut().for_each(DdaPairContact::stick);
        for _ in 0..SOLVES {
            self.sweeps += 1;
            self.solve_once(links, dt)?;
            let mut changed = false;
            // all contacts stick now: no friction state is left to change, but contacts may still open and close
            for member in &mut self.members {
                let d = member.way();
                for joint in &mut member.joints {
                    changed |= joint.open_or_close(&d);
                }
            }
            for link in links.iter_mut() {
                let d = link.ends.map(|k| self.members[k].way());
                changed |= link.open_or_close([&d[0], &d[1]]);
            }
            if !changed {
                break;
            }
        }
        Some(false)
    }

    /// One solve of the system with the contact states as they are; `None` if it is singular or no longer finite.
    ///
    /// One pass of assembly and factorisation; blocks of contacts are those of the paper's
    /// submatrices.
    fn solve_once(&mut self, links: &[DdaPairContact], dt: f64) -> Option<()> {
        let solved = self.global.solve(&mut self.members, links, dt);
        let finite = self.members.iter().all(|m| m.ways[1].iter().all(|x| x.is_finite()));
        (solved && finite).then_some(())
    }

    /// Judges every contact at the displacements found: open, sticking or slipping. The largest change is returned; a
    /// change of load alone (friction follows the normal force) needs no new factor.
    fn judge(&mut self, links: &mut [DdaPairContact]) -> Change {
        let mut change = Change::None;
        for member in &mut self.members {
            let d = member.way();
            for joint in &mut member.joints {
                change = change.max(joint.judge(&d));
            }
        }
        for link in links {
            let d = link.ends.map(|k| self.members[k].way());
            change = change.max(link.judge([&d[0], &d[1]]));
        }
        change
    }

    /// Writes the state of the contacts between rocks into their memory, and books what each end got from the other
    /// (J).
    ///
    /// # Errors
    /// [`StepError::SankIn`] if a contact is deeper than the springs are meant for: the step is too long for them.
    ///
    /// Energy: the work of a contact on each of its ends; what they do not get back is lost in it,
    /// half to each.
    fn remember(&mut self, links: &[DdaPairContact], done: &mut Done) -> Result<(), StepError> {
        for pair_history in &mut self.pair_histories {
            pair_history.closed = false;
        }
        for link in links {
            let d = link.ends.map(|k| self.members[k].way());
            let d = [&d[0], &d[1]];
            // half of the smaller radius: deeper, the normal may point the wrong way
            let least = link.ends.map(|k| self.members[k].body.radius);
            if link.depth(d) > DEEPEST * least[0].min(least[1]) {
                return Err(StepError::SankIn);
            }
            let given = Given::of_ends([-link.work(0, d), -link.work(1, d)]);
            for (end, given) in link.ends.into_iter().zip(given) {
                done.given[end].add(&given, 1.0);
            }
            done.broken += u64::from(link.remember(d, &mut self.pair_histories[link.pair_history]));
        }
        for member in &mut self.members {
            member.flying = member.state.is_free();
        }
        for pair_history in self.pair_histories.iter().filter(|pair_history| pair_history.is_held())
        {
            for k in [pair_history.a, pair_history.b] {
                self.members[k as usize].flying = false;
            }
        }
        Ok(())
    }
}

impl IslandBody {
    /// Displacement of the step.
    /// Paper Eq. (1), `D = D₀ + E`.
    fn way(&self) -> Vec6 {
        self.ways[0] + self.ways[1]
    }

    /// What all contacts of this rock have in common within the step.
    fn fixed_step(&self, (dt, shear_memory): (f64, bool)) -> StepConstants {
        StepConstants {
            dt,
            free: self.ways[0],
            radius: self.body.radius,
            compliance: compliance(&self.body, dt),
            shear_memory,
        }
    }

    /// Makes the touches of the step's start into contacts; what their springs hold.
    /// Normals and levers are those of this place for the whole step, as in the paper.
    fn meet(&mut self, terrain: &Terrain, how: (f64, bool)) -> Loss {
        let c = self.state.c;
        let world = ContactEnvironment { terrain, body: self.body, laws: &self.laws };
        self.state.look_ahead(&world, &c);
        let stored = self.state.stored_j(&world);
        self.ways = [free_motion(&world, &self.state, how.0), Vec6::zeros()];
        self.joints.clear();
        for k in 0..self.state.touches.len() {
            self.add_joint(terrain, how, (k, self.state.touches[k].distance_m));
        }
        stored
    }

    /// Makes touch `k` a contact of the step, with the memory of the contact that it continues.
    ///
    /// `distance_m` is that of the plane of the touch from the centre at the step's start: for one
    /// found at the end it is counted back.
    fn add_joint(&mut self, terrain: &Terrain, how: (f64, bool), (k, distance_m): (usize, f64)) {
        let step = self.fixed_step(how);
        let Self { state, body, laws, joints, .. } = self;
        let world = ContactEnvironment { terrain, body: *body, laws };
        let taken = joints.iter().fold(0, |taken, joint| taken | 1 << joint.history);
        let v = state.v;
        let history = state.history_of(&world, k, taken, &v);
        let touch = ContactPoint { distance_m, ..state.touches[k] };
        let law = world.law_of(&state.touches, k);
        joints.push(DdaContact::new(&step, &law, &touch, (history, &state.histories[history])));
    }

    /// Adds the contacts that the step ran into; whether there are any.
    fn meet_more(&mut self, terrain: &Terrain, how: (f64, bool)) -> bool {
        let d = self.way();
        let way: Vec3 = d.fixed_rows::<3>(0).into();
        // looked for where the rock would end: what it would run into must push back within the same step
        let end = self.state.c + way;
        let world = ContactEnvironment { terrain, body: self.body, laws: &self.laws };
        self.state.look_ahead(&world, &end);
        let touches = self.state.touches;
        let before = self.joints.len();
        for (k, touch) in touches.iter().enumerate() {
            let is_inside =
                touch.distance_m < self.body.radius && self.joints.len() < crate::contact::MOST;
            if is_inside && !knows(&self.joints, touch, &touches, &d) {
                self.add_joint(terrain, how, (k, touch.distance_m - touch.normal.dot(&way)));
            }
        }
        self.joints.len() > before
    }

    /// Moves the rock, and gives what its contacts with the mesh took.
    /// `v₁ = v₀ + g Δt + 2E/Δt`, with `E` what contacts add to the free displacement.
    fn carry_on(&mut self, terrain: &Terrain, dt: f64, before: &Loss) -> Result<Loss, StepError> {
        let (d, kick) = (self.way(), self.ways[1] * (2.0 / dt));
        let Self { state, body, laws, joints, .. } = self;
        let world = ContactEnvironment { terrain, body: *body, laws };
        let mut loss = Loss::default();
        for history in state.histories.iter_mut() {
            history.closed = false;
        }
        for joint in joints.iter() {
            if joint.depth(&d) > DEEPEST * body.radius {
                return Err(StepError::SankIn);
            }
            loss.add(&joint.loss(&d).on(&world, joint.triangle), 1.0);
            joint.remember(&d, &mut state.histories[joint.history]);
        }
        state.merge_lost(&world);
        state.histories.retain(|history| history.closed);
        // the rotation needs no update: a sphere looks the same from all sides
        state.c += d.fixed_rows::<3>(0);
        state.v += body.gravity * dt + kick.fixed_rows::<3>(0);
        state.w += kick.fixed_rows::<3>(3);
        // what springs hold more at the end than at the start is taken from motion, but not lost
        loss.add(&state.stored_j(&world), 1.0);
        loss.add(before, -1.0);
        Ok(loss)
    }
}
