//! Scheme `rigid` for an island: the limit of stiff springs for rocks that touch each other.
//!
//! A step has three parts. Sustained contact is solved for the whole island at velocity level; then the impacts within the
//! step are resolved in the order of their times; then rocks that still overlap are moved apart. The length of the step
//! follows from the speed of the fastest rock alone, so that the cost grows linearly with the number of rocks. An island
//! of one rock has the scheme of a rock alone.
//!
//! ```text
//! resting_contacts      v₁ = v₀ + g Δt + M⁻¹ Σ J        sustained contacts, geometry of the middle of the step
//! expected              prediction of the impacts and their times
//! impacts               impacts between v₀ and v₁, each at its own time within the step
//! position_correction   c moved out of overlaps, with the energy balanced
//! ```

mod blow_start;
mod broken_stems;
mod collision;
mod contacts;
mod expected;
mod position_correction;
mod newton_step;
mod impacts;
mod resting_contacts;
mod sweeps;

use super::body::{BodySlot, IslandBody, note_flights};
use super::contact_queue::{ContactQueue, ContactsOfRocks};
use super::outcome::{BlowInStep, IslandAdvance, MeshImpact};
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::rock::Vec3;
use crate::solver::body::are_finite;
use crate::solver::impact::BlowTable;
use crate::solver::law::capture_m_s;
use crate::solver::loss::EnergyGiven;
use crate::solver::loss::Loss;
use crate::solver::rigid::{GroundContact, HELD, update_histories};
use crate::solver::step_control::StepError;
use crate::terrain::Terrain;
pub(crate) use contacts::blows_of;
use contacts::{BallContact, ImpactScene, StepBody};
use impacts::PendingImpact;
use position_correction::NearPair;
use std::collections::BinaryHeap;
use std::sync::Arc;
use sweeps::ConjugateDirections;

/// Longest path of a rock in one step (–, relative to its radius). Impacts on it are found wherever they are; the error of
/// a sliding contact on a curved surface is the square of half of this.
pub const TRAVEL: f64 = 0.2;

/// Work space of the rigid steps of an island.
/// Reused from step to step and from island to island, so that a step of a thousand rocks hardly allocates.
#[derive(Debug, Default)]
pub(crate) struct RigidIsland {
    balls: Vec<StepBody>,
    ground_contacts: Vec<GroundContact>,
    ball_contacts: Vec<BallContact>,
    losses: Vec<Loss>,
    given: Vec<EnergyGiven>,
    hits: Vec<MeshImpact>,
    blows_in_step: Vec<BlowInStep>,
    pending: BinaryHeap<PendingImpact>,
    /// Which pairs had an impact.
    struck: Vec<bool>,
    /// The rocks of the last impact.
    in_blow: Vec<usize>,
    /// Pairs or contacts of every rock.
    of_rocks: ContactsOfRocks,
    /// Contacts to be solved again.
    queue: ContactQueue,
    /// Rocks whose motion the current sweep has changed.
    changed: Vec<usize>,
    conjugate: ConjugateDirections,
    /// Energy dissipated by the normal impulses of sustained contacts in this step (J).
    taken_j: f64,
    places: Vec<Vec3>,
    /// Pairs that may overlap during the position correction.
    near: Vec<NearPair>,
    /// Smallest capture speed (m/s).
    capture_m_s: f64,
    /// Length of the current step (s).
    dt: f64,
    /// Table of impacts between rocks of one material.
    blows: Option<Arc<BlowTable>>,
    sweeps: u64,
    newton_steps: u64,
}

impl RigidIsland {
    /// One step of several rocks, at most `longest` and `h_max` (s) long.
    ///
    /// # Errors
    /// [`StepError`] if motion is no longer finite.
    ///
    /// The order matters: sustained contact gives each rock the path on which its impacts are predicted.
    pub(super) fn advance(
        &mut self,
        terrain: &Terrain,
        members: &mut [BodySlot],
        pair_histories: &mut [PairHistory],
        (longest, h_max): (f64, f64),
    ) -> Result<IslandAdvance, StepError> {
        self.begin(members, pair_histories);
        let dt = self.step_s(longest, h_max);
        let settled = self.solve_resting_contacts(terrain, (members, pair_histories), dt);
        let mut scene = ImpactScene { terrain, members, pair_histories };
        let struck = self.resolve_impacts(&mut scene, dt);
        self.correct_positions(&mut scene);
        let finite = self.balls.iter().all(StepBody::is_finite);
        self.take_over(terrain, (members, pair_histories), dt);
        // impacts come in the order of their times, and are reported rock by rock
        self.hits.sort_by_cached_key(|hit| hit.rock);
        self.blows_in_step.sort_by_cached_key(|blow| blow.rock);
        let done = IslandAdvance {
            dt,
            losses: std::mem::take(&mut self.losses),
            given: std::mem::take(&mut self.given),
            hits: std::mem::take(&mut self.hits),
            blows: std::mem::take(&mut self.blows_in_step),
            unsettled: !(settled && struck),
            ..IslandAdvance::default()
        };
        if finite { Ok(done) } else { Err(StepError::NotFinite) }
    }

    /// With the table of impacts of a world whose rocks are of one material.
    pub(crate) fn of_material(blows: Option<Arc<BlowTable>>) -> Self {
        Self { blows, ..Self::default() }
    }

    /// Numbers of sweeps and Newton steps since the last call.
    pub(super) fn take_effort(&mut self) -> (u64, u64) {
        (std::mem::take(&mut self.sweeps), std::mem::take(&mut self.newton_steps))
    }

    /// Writes the end of the step to rocks and pairs.
    /// Impulses over the length of the step are the forces of the next warm start.
    fn take_over(
        &self,
        terrain: &Terrain,
        (members, pair_histories): (&mut [BodySlot], &mut [PairHistory]),
        dt: f64,
    ) {
        for (pair_history, struck) in pair_histories.iter_mut().zip(&self.struck) {
            let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.balls[k as usize]);
            let (n, distance) = normal_and_distance(&a.c, &b.c);
            // a contact a little apart stays closed: rounding must not open the contacts of a heap
            let reach = a.body.radius + b.body.radius + HELD * a.body.radius.min(b.body.radius);
            pair_history.n = n;
            pair_history.closed =
                *struck && distance <= reach && pair_history.is_slow(&(a.v - b.v));
            (pair_history.normal_force, pair_history.shear_force, pair_history.slides) =
                (0.0, Vec3::zeros(), false);
            // a contact without restitution from now on, until the rocks are apart
            pair_history.captured = true;
            if distance > reach {
                pair_history.captured = false;
            }
        }
        for ball_contact in
            self.ball_contacts.iter().filter(|ball_contact| ball_contact.normal_impulse > 0.0)
        {
            let pair_history = &mut pair_histories[ball_contact.pair_history];
            let [a, b] = ball_contact.ends.map(|k| &self.balls[k]);
            (pair_history.normal_force, pair_history.shear_force) =
                (ball_contact.normal_impulse / dt, ball_contact.shear_impulse / dt);
            pair_history.slides = ball_contact
                .limits
                .slides(ball_contact.shear_impulse.norm(), ball_contact.normal_impulse);
            // contacts that carried a load are candidates of the next step
            pair_history.closed |= pair_history.is_slow(&(a.v - b.v));
        }
        let mut ground_contacts = self
            .ground_contacts
            .iter()
            .filter(|ground_contact| ground_contact.normal_impulse > 0.0)
            .peekable();
        for (k, (member, ball)) in members.iter_mut().zip(&self.balls).enumerate() {
            let member = &mut **member;
            member.last_forces.clear();
            while let Some(ground_contact) =
                ground_contacts.next_if(|ground_contact| ground_contact.rock == k)
            {
                let kept = (
                    ground_contact.normal_impulse / dt,
                    ground_contact.shear_impulse / dt,
                    ground_contact.rolling_impulse / dt,
                );
                member.last_forces.push((ground_contact.feature, kept.0, kept.1, kept.2));
            }
            member.land_on(terrain, ball);
        }
        note_flights(members, pair_histories);
    }
}

impl PairHistory {
    /// Whether two rocks with this velocity of the first relative to the second do not part.
    fn is_slow(&self, apart_m_s: &Vec3) -> bool {
        self.n.dot(apart_m_s) < capture_m_s(&self.law)
    }
}

impl StepBody {
    fn is_finite(&self) -> bool {
        are_finite([&self.c, &self.v, &self.w])
    }
}

impl RigidIsland {
    /// Takes the rocks over at the start of a step.
    /// Losses and hits are those of one step; contacts are found anew in it.
    fn begin(&mut self, members: &[BodySlot], pair_histories: &[PairHistory]) {
        self.balls.clear();
        let ball = |member: &BodySlot| {
            let state = &member.state;
            StepBody::new(&member.body, (state.c, state.v, state.w))
        };
        self.balls.extend(members.iter().map(ball));
        self.losses.clear();
        self.losses.resize(members.len(), Loss::default());
        self.given.clear();
        self.given.resize(members.len(), EnergyGiven::default());
        self.struck.clear();
        self.struck.resize(pair_histories.len(), false);
        self.hits.clear();
        self.blows_in_step.clear();
        let slowest = pair_histories
            .iter()
            .map(|pair_history| capture_m_s(&pair_history.law))
            .fold(f64::INFINITY, f64::min);
        self.capture_m_s = if slowest.is_finite() { slowest } else { 0.0 };
    }

    /// Length of the step (s): the time left in equal parts.
    /// Equal parts of the window, so that no remnant is left for the last.
    fn step_s(&self, longest: f64, h_max: f64) -> f64 {
        let way = |ball: &StepBody| {
            // the fastest that it may get within the window
            let speed = ball.v.norm() + ball.body.gravity.norm() * h_max;
            TRAVEL * ball.body.radius / speed.max(f64::MIN_POSITIVE)
        };
        let most = self.balls.iter().map(way).fold(longest, f64::min);
        if most >= h_max { h_max } else { h_max / (h_max / most).ceil() }
    }
}

impl IslandBody {
    /// Takes over the end of a step in an island.
    fn land_on(&mut self, terrain: &Terrain, ball: &StepBody) {
        self.flew = self.flying;
        self.was_touched = ball.pushed || ball.moved;
        let (world, state) = self.with_environment(terrain);
        (state.c, state.v, state.w) = (ball.c, ball.v, ball.w);
        update_histories(&world, state, ball.pushed);
        state.impact_announced = false;
    }
}
