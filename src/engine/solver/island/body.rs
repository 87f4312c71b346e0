//! One rock of an island.
//!
//! The state of a rock alone (`ContactState`), and what an island adds: base and guess of the
//! present stage, motions with and without contact forces, and the energy given to other rocks.

use super::outcome::IslandAdvance;
use crate::contact::Feature;
use crate::contact::history::ContactHistory;
use crate::contact::pair::PairHistory;
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::body::{Body, STILL, Twist};
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::impact_progress::ImpactProgress;
use crate::solver::law::StageContact;
use crate::solver::loss::EnergyGiven;
use crate::solver::roughness::RoughFacets;
use crate::solver::stage::StageMotion;
use crate::solver::stem_load::StemLoad;
use crate::solver::step_control::{Advance, StepError};
use crate::solver::tableau::{STAGES, Tableau};
use crate::terrain::Terrain;
use std::ops::{Deref, DerefMut};

/// One rock of an island.
#[derive(Debug)]
pub struct IslandBody {
    /// Motion, contacts with the mesh and scratch space.
    pub state: ContactState,
    /// Mass, size, gravity.
    pub body: Body,
    /// The law of every ground for this rock.
    pub laws: Vec<Law>,
    /// Whether it has no contact.
    pub flying: bool,
    /// Whether it had no contact before the last step (`rigid`).
    pub flew: bool,
    /// Whether any force but its weight acted on it in the last step (`rigid`).
    pub was_touched: bool,
    /// Local error allowed in sustained contact, and speed of the fastest impact under way, 0 if
    /// none (m/s).
    pub(super) sustained_tolerance_m_s: f64,
    pub(super) impact_m_s: f64,
    /// Number of bodies in contact with it: other rocks, and the mesh as one.
    pub(super) touched_count: u32,
    /// The largest such number among it and the rocks in contact with it.
    pub(super) max_touched_count: u32,
    /// The stage's base `x* = x + h Σ a_ij f_j`, and the guess of the centre at its end (m).
    pub(super) base: StageMotion,
    pub(super) guess: Vec3,
    /// Velocity and spin at the stage's end without contact forces.
    pub(super) free: Twist,
    /// End of the stage; after the last stage, of the step.
    pub(super) end: StageMotion,
    /// Contact forces of the last solution, the initial guess of the next.
    pub(super) last_forces: Vec<(Feature, f64, Vec3, Vec3)>,
    /// Power given to other rocks at each stage (W).
    pub(super) given: [EnergyGiven; STAGES],
    /// Number of contact histories at the step's start: a rejected try goes back to them.
    pub(super) histories_at_start: usize,
}

/// State of a rock between two steps: everything that later steps depend on. Scratch space and
/// geometry are not included: they follow from the motion.
#[derive(Debug)]
pub struct MotionSnapshot {
    motion: (Vec3, Vec3, Vec3),
    histories: Vec<ContactHistory>,
    impact: ImpactProgress,
    /// Whether the present blow has been announced (`rigid`), and the contacts of the next one.
    blow: (bool, Vec<ContactHistory>),
    facets: RoughFacets,
    stems: (StemLoad, Vec<u32>),
    flying: bool,
}

/// Slot that owns a rock. The rock is lent to its island while that steps; only its address moves.
#[derive(Debug, Default)]
pub struct BodySlot(Option<Box<IslandBody>>);

impl BodySlot {
    /// A slot with a rock.
    pub fn new(member: IslandBody) -> Self {
        Self(Some(Box::new(member)))
    }

    /// Lends the rock; the slot stays empty until it is given back.
    #[must_use]
    pub fn lend(&mut self) -> Self {
        Self(self.0.take())
    }
}

#[expect(clippy::expect_used, reason = "a rock is away only while its island steps")]
impl Deref for BodySlot {
    type Target = IslandBody;
    #[inline]
    fn deref(&self) -> &IslandBody {
        self.0.as_deref().expect("the rock is at home")
    }
}

#[expect(clippy::expect_used, reason = "a rock is away only while its island steps")]
impl DerefMut for BodySlot {
    #[inline]
    fn deref_mut(&mut self) -> &mut IslandBody {
        self.0.as_deref_mut().expect("the rock is at home")
    }
}

impl IslandBody {
    /// A rock in flight at `(c, v, w)`.
    pub fn new(body: Body, laws: Vec<Law>, (c, v, w): (Vec3, Vec3, Vec3)) -> Self {
        let end = StageMotion { c, v, w };
        let state = ContactState { c, v, w, ..ContactState::unused() };
        Self {
            state,
            body,
            laws,
            flying: true,
            flew: true,
            was_touched: false,
            sustained_tolerance_m_s: 0.0,
            impact_m_s: 0.0,
            touched_count: 0,
            max_touched_count: 0,
            base: end,
            guess: c,
            free: STILL,
            end,
            last_forces: Vec::new(),
            given: [EnergyGiven::default(); STAGES],
            histories_at_start: 0,
        }
    }

    /// A snapshot of the rock between two steps.
    pub fn snapshot(&self) -> MotionSnapshot {
        let state = &self.state;
        MotionSnapshot {
            motion: (state.c, state.v, state.w),
            histories: state.histories.to_vec(),
            impact: state.impact.clone(),
            blow: (state.impact_announced, state.upcoming_impacts.to_vec()),
            facets: state.facets.clone(),
            stems: (state.stem_load.clone(), state.near.broken_stems.clone()),
            flying: self.flying,
        }
    }

    /// Restores a snapshot, to the bit: the rock then repeats its motion, if nothing else has
    /// changed.
    pub fn restore(&mut self, snapshot: &MotionSnapshot) {
        let state = &mut self.state;
        (state.c, state.v, state.w) = snapshot.motion;
        state.histories.restore(&snapshot.histories);
        state.impact.clone_from(&snapshot.impact);
        state.impact_announced = snapshot.blow.0;
        state.upcoming_impacts.restore(&snapshot.blow.1);
        state.facets.clone_from(&snapshot.facets);
        state.plane.forget();
        state.stem_load.clone_from(&snapshot.stems.0);
        if state.near.broken_stems != snapshot.stems.1 {
            state.near.broken_stems.clone_from(&snapshot.stems.1);
            state.near.forget();
        }
        state.fresh = false;
        self.flying = snapshot.flying;
        self.last_forces.clear();
    }

    /// Prepares the rock for an island that knows nothing of the steps before.
    pub(super) fn enter_island(&mut self) {
        self.state.plane.forget();
        self.state.fresh = false;
    }

    /// One step of a rock that only the mesh can touch: that of a single rock.
    pub(super) fn advance_alone(
        &mut self,
        terrain: &Terrain,
        advance: impl FnOnce(&ContactEnvironment, &mut ContactState) -> Result<Advance, StepError>,
    ) -> Result<IslandAdvance, StepError> {
        self.flew = self.flying;
        self.last_forces.clear();
        let (world, state) = self.with_environment(terrain);
        let done = advance(&world, state)?;
        self.flying = self.state.is_free();
        Ok(IslandAdvance {
            dt: done.dt,
            rejected: done.rejected,
            losses: vec![done.loss],
            given: vec![EnergyGiven::default()],
            unsettled: done.unsettled,
            ..IslandAdvance::default()
        })
    }

    /// Its environment on a terrain.
    #[inline]
    pub(crate) fn environment<'w>(&'w self, terrain: &'w Terrain) -> ContactEnvironment<'w> {
        ContactEnvironment { terrain, body: self.body, laws: &self.laws }
    }

    /// Its environment and its mutable state.
    #[inline]
    pub(crate) fn with_environment<'w>(
        &'w mut self,
        terrain: &'w Terrain,
    ) -> (ContactEnvironment<'w>, &'w mut ContactState) {
        (ContactEnvironment { terrain, body: self.body, laws: &self.laws }, &mut self.state)
    }

    pub(super) fn contacts(&self) -> &[StageContact] {
        self.state.stage_contacts()
    }

    /// Speed that the springs of its contacts with the mesh can give it (m/s): `Σ F/(m ω)`.
    ///
    /// A spring of frequency `ω` under the force `F` has stored `F²/(2 m ω²)`: released, it gives
    /// `m` the speed `F/(m ω)`.
    pub fn pressed_m_s(&self, terrain: &Terrain) -> f64 {
        let world = self.environment(terrain);
        let histories = self.state.histories.iter();
        histories
            .map(|history| {
                history.normal_force / (self.body.mass * world.springs_of(history).omega_rad_s())
            })
            .sum()
    }

    /// Whether it touched the mesh, or nearly, at the last contact search: its gap was less than
    /// `way` (m), at most a tenth of its radius.
    pub fn is_near_mesh(&self, way: f64) -> bool {
        let reach = self.body.radius + way;
        !self.state.histories.is_empty()
            || self.state.touches.iter().any(|touch| touch.distance_m <= reach)
    }

    /// Whether a feature of the mesh pressed on it at the end of the last step.
    pub(super) fn is_held_on(&self, feature: Feature) -> bool {
        self.last_forces.iter().any(|(held, ..)| *held == feature)
    }

    /// Frequency of its stiffest contact with the mesh (rad/s), 0 if there is none.
    pub fn omega(&self, terrain: &Terrain) -> f64 {
        self.state.stiffest_rad_s(&self.environment(terrain))
    }
}

impl IslandBody {
    /// Finds the contact points at the guess of the stage's end.
    pub(super) fn find_contact_points(&mut self, terrain: &Terrain) {
        let guess = self.guess;
        let (world, state) = self.with_environment(terrain);
        state.find_contact_points_ahead(&world, &guess);
    }

    /// Makes the contact points of the guess into contacts of stage `i`; forces start from those of
    /// the last solution on the same feature (warm start).
    pub(super) fn place_contacts(
        &mut self,
        terrain: &Terrain,
        tableau: &Tableau,
        (i, h): (usize, f64),
    ) {
        let (base, guess) = (self.base, self.guess);
        let (world, state) = self.with_environment(terrain);
        state.place_contacts(&world, tableau, (i, h), (&base, &guess));
        for contact in &mut self.state.contacts[..self.state.contact_count] {
            // the forces on the same feature are the best initial guess
            let kept = self.last_forces.iter().find(|kept| kept.0 == contact.feature);
            if let Some((_, normal_force, shear_force, rolling_moment)) = kept {
                (contact.normal_force, contact.shear_force, contact.rolling_moment) =
                    (*normal_force, *shear_force, *rolling_moment);
            }
        }
    }

    /// Stores the solution of stage `i`, velocity and spin with its forces, as rates, and the
    /// forces as the next initial guess.
    pub(super) fn store(&mut self, terrain: &Terrain, (v, w): Twist, (i, hh): (usize, f64)) {
        let base = self.base;
        let end = StageMotion { c: base.c + v * hh, v, w };
        self.end = end;
        let (world, state) = self.with_environment(terrain);
        state.store(&world, &base, &end, (i, hh));
        self.last_forces.clear();
        let contacts = self.state.stage_contacts();
        self.last_forces.extend(
            contacts.iter().map(|s| (s.feature, s.normal_force, s.shear_force, s.rolling_moment)),
        );
    }
}

/// Notes which rocks fly: those in contact with neither the mesh nor another rock.
pub(super) fn note_flights(members: &mut [BodySlot], pair_histories: &[PairHistory]) {
    for member in &mut *members {
        member.flying = member.state.is_free();
    }
    for pair_history in pair_histories.iter().filter(|pair_history| pair_history.is_held()) {
        for k in [pair_history.a, pair_history.b] {
            members[k as usize].flying = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::ContactPoint;
    use crate::contact::history::ContactHistories;
    use crate::rock::Rock;

    /// A window that is repeated announces the blows of the rigid limit as before, each once.
    #[test]
    fn a_rock_that_goes_back_knows_of_its_blow_what_it_knew() {
        let rock = Rock { radius_m: 0.5, density_kg_m3: 2700.0 };
        let start = (Vec3::z(), Vec3::x(), Vec3::zeros());
        let mut member = IslandBody::new(Body::new(&rock, 9.8), Vec::new(), start);
        member.state.impact_announced = false;
        member.state.upcoming_impacts.push(ContactHistory::new(&ContactPoint::NONE, false));
        let snapshot = member.snapshot();
        (member.state.impact_announced, member.state.upcoming_impacts) =
            (true, ContactHistories::default());
        member.restore(&snapshot);
        assert!(!member.state.impact_announced);
        assert_eq!(member.state.upcoming_impacts.len(), 1);
    }
}
