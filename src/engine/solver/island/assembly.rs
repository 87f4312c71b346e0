//! An island of rocks that may touch each other, and its adaptive step.
//!
//! All rocks of an island that are in contact take one step of a stiffly accurate Runge–Kutta
//! method together. A stage is a nonlinear system in the six velocities of each rock; its contacts
//! are solved by sweeps and Newton steps. The step is accepted if the embedded error is within the
//! tolerance and the island's energy has not risen.

use super::active_set::ActiveSet;
use super::body::{BodySlot, IslandBody};
use super::outcome::IslandAdvance;
use super::pair_contact::PairContact;
use super::rigid::RigidIsland;
use crate::contact::pair::{PairHistory, normal_and_distance};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::solver::Settings;
use crate::solver::body::Twist;
use crate::solver::contact_state::Onset;
use crate::solver::dda::DdaPairs;
use crate::solver::step_control::{self, Control, ONSET, StepError};
use crate::solver::tableau::{STAGES, TR_BDF2};
use crate::terrain::Terrain;

/// Overload beyond which a bond does not simply break: the step is shortened to resolve the moment.
const OVERLOAD: f64 = 0.05;

/// An island: rocks, and a history for each pair that may touch.
#[derive(Debug)]
pub struct Island<'a> {
    /// The mesh.
    pub terrain: &'a Terrain,
    /// The rocks.
    pub members: Vec<BodySlot>,
    /// The pairs, in ascending order; `a` and `b` are places in `members`.
    pub pair_histories: Vec<PairHistory>,
    /// Step to try next (s).
    pub h: f64,
    /// Sweeps over the contacts so far.
    pub sweeps: u64,
    /// Newton steps so far: systems solved by factorisation.
    pub newton_steps: u64,
    /// Whether the first rates belong to the present state.
    pub fresh: bool,
    pub(super) pairs: Vec<PairContact>,
    /// Velocity and spin of every rock at the stage's end, with the present forces. They are kept
    /// apart from the rocks because sweeps need little else.
    pub(super) motions: Vec<Twist>,
    pub(super) active: ActiveSet,
    pub(super) tolerance: f64,
    /// Onsets of impacts of two rocks in the present try; those on the mesh are with the rocks.
    pub(super) onset: Onset,
    /// Rates of the shear springs at each stage.
    pub(super) pair_rates: Vec<[Vec3; STAGES]>,
    /// Forces of the last solution.
    pub(super) pair_forces: Vec<(f64, Vec3)>,
    /// Contacts between rocks in fixed steps, and their system.
    pub(super) dda_pairs: DdaPairs,
    /// Work space of rigid steps.
    pub(crate) rigid: RigidIsland,
}

impl<'a> Island<'a> {
    /// An island of these rocks.
    pub fn new(
        terrain: &'a Terrain,
        mut members: Vec<BodySlot>,
        pair_histories: Vec<PairHistory>,
    ) -> Self {
        for member in &mut members {
            member.enter_island();
        }
        let pair_forces = pair_histories
            .iter()
            .map(|pair_history| (pair_history.normal_force, pair_history.shear_force))
            .collect();
        Self {
            terrain,
            members,
            h: f64::INFINITY,
            sweeps: 0,
            newton_steps: 0,
            fresh: false,
            pairs: Vec::new(),
            motions: Vec::new(),
            active: ActiveSet::default(),
            tolerance: 0.0,
            onset: Onset::default(),
            pair_rates: Vec::new(),
            pair_forces,
            dda_pairs: DdaPairs::default(),
            rigid: RigidIsland::default(),
            pair_histories,
        }
    }

    /// One accepted step of at most `h_max` (s).
    ///
    /// # Errors
    /// [`StepError`] if the step had to become too short to matter.
    pub fn advance(&mut self, settings: &Settings, h_max: f64) -> Result<IslandAdvance, StepError> {
        if let [member] = &mut self.members[..] {
            let tableau = settings.scheme.tableau().unwrap_or(&TR_BDF2);
            let h = &mut self.h;
            return member.advance_alone(self.terrain, |world, state| {
                let control = Control::new(tableau, settings, world);
                if !h.is_finite() {
                    *h = step_control::first_step(world, state);
                }
                step_control::advance(world, &control, state, h, h_max)
            });
        }
        if self.release_struck() {
            // the dashpots have changed, and the impact must be resolved
            self.fresh = false;
            self.h = self.h.min(ONSET / self.omega());
        }
        let control = &self.control(settings);
        // a rock rotated onto a facet, or whose stem has broken, has other rates
        if !self.fresh || self.members.iter().any(|member| !member.state.fresh) {
            self.rates_now();
            self.accept_new_contacts();
        }
        let omega = self.omega();
        if !self.h.is_finite() {
            self.h = ONSET / omega;
        }
        self.members
            .iter_mut()
            .for_each(|member| member.histories_at_start = member.state.histories.len());
        // as long as error, energy and bonds allow, and cut at the onsets and ends of impacts
        let (dt, rejected) = self.find_accepted_step(control, omega, h_max)?;
        let done = self.accept(control.tableau, dt);
        self.begin_deferred_impacts();
        let finite = self.members.iter().all(|member| member.state.is_finite());
        if finite { Ok(IslandAdvance { rejected, ..done }) } else { Err(StepError::NotFinite) }
    }

    /// One step of the scheme `rigid`, at most `longest` and `h_max` (s) long.
    ///
    /// # Errors
    /// [`StepError`] if motion is no longer finite.
    pub fn advance_rigid(&mut self, longest: f64, h_max: f64) -> Result<IslandAdvance, StepError> {
        let Self { terrain, members, pair_histories, rigid, .. } = self;
        if let [member] = &mut members[..] {
            return member.advance_alone(terrain, |world, state| {
                crate::solver::rigid::advance(world, state, longest, h_max)
            });
        }
        let done = rigid.advance(terrain, members, pair_histories, (longest, h_max));
        let (sweeps, newton_steps) = rigid.take_effort();
        self.sweeps += sweeps;
        self.newton_steps += newton_steps;
        done
    }

    /// Whether kinetic energy, height and springs of the whole island together have more energy at
    /// the step's end than at its start.
    pub(super) fn gains_energy(&self, hh: f64) -> bool {
        // `rounding_j`: energy within the rounding of positions, weight and normal forces times a
        // length
        let (mut before, mut after, mut rounding_j) = (0.0, 0.0, 0.0);
        for IslandBody { state, body, end, .. } in self.members.iter().map(|member| &**member) {
            let [own_before, own_after] = step_control::energies_j(body, state, (end, hh));
            (before, after) = (before + own_before, after + own_after);
            rounding_j +=
                step_control::PLACE_ROUNDING * body.radius * body.mass * body.gravity.norm();
        }
        for pair_history in self.pair_histories.iter().filter(|pair_history| pair_history.is_held())
        {
            let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.members[k as usize]);
            let (_, distance) = normal_and_distance(&a.state.c, &b.state.c);
            before += pair_history.stored_j(distance, a.body.radius + b.body.radius);
        }
        for pair in &self.pairs {
            let ends = pair.ends.map(|k| (self.members[k].end.v, self.members[k].end.w));
            // at the end of the stage: the base's penetration less the normal displacement
            let mut penetration = pair.penetration_at(pair.speed([&ends[0], &ends[1]]), hh);
            if pair.bond.is_none() {
                penetration = penetration.max(0.0);
            }
            if penetration > 0.0 || pair.normal_force > 0.0 || pair.bond.is_some() {
                let shear = pair.stretch(hh);
                after += pair.law.stored_j(penetration, shear.norm_squared(), 0.0);
            }
            let least = pair.levers[0].min(pair.levers[1]);
            rounding_j += step_control::PLACE_ROUNDING * least * pair.normal_force.abs();
        }
        after > before + step_control::ROUNDING * before + rounding_j
    }

    /// Largest `√(p_N/m)` among present contacts, or among possible ones without any (rad/s).
    pub(super) fn omega(&self) -> f64 {
        let pair_histories = self
            .pair_histories
            .iter()
            .filter(|pair_history| pair_history.is_held())
            .map(|pair_history| pair_history.law.omega_rad_s());
        let ground = self.members.iter().map(|member| member.omega(self.terrain));
        let omega = pair_histories.chain(ground).fold(0.0, f64::max);
        let all = self.members.iter().flat_map(|member| &member.laws).map(Law::omega_rad_s);
        if omega > 0.0 { omega } else { all.fold(1.0, f64::max) }
    }

    /// Longest step in which the travel of no rock exceeds `travel` (–, relative to R) and no
    /// feature or other rock is missed (s).
    pub(super) fn travel_limit(&mut self, travel: f64) -> f64 {
        let mut limit = f64::INFINITY;
        for member in self.members.iter_mut().filter(|member| !member.flying) {
            let (world, state) = member.with_environment(self.terrain);
            limit = limit.min(state.longest_step(&world, travel));
        }
        for pair_history in &self.pair_histories {
            let [a, b] = [pair_history.a, pair_history.b].map(|k| &self.members[k as usize]);
            if a.flying && b.flying && !pair_history.is_held() {
                continue;
            }
            // two rocks may close their gap and then penetrate by a part of the smaller radius
            let gap = (a.state.c - b.state.c).norm() - a.body.radius - b.body.radius;
            let room = travel * a.body.radius.min(b.body.radius) + gap.max(0.0);
            let speed = (a.state.v - b.state.v).norm();
            if speed > 0.0 {
                limit = limit.min(room / speed);
            }
        }
        limit
    }

    /// One try of a step; its error relative to the tolerance, `None` if a stage does not converge.
    /// The implicit stages follow each other; the last one is the step's end, because the tableau
    /// is stiffly accurate.
    pub(super) fn attempt(&mut self, control: &Control, dt: f64) -> Option<f64> {
        let tableau = control.tableau;
        for i in 1..tableau.stages {
            self.stage(tableau, i, dt)?;
            if self.overloads_bond() {
                return None;
            }
        }
        self.note_impacts(true);
        Some(dt * self.error(control))
    }

    /// Whether a bond is loaded far beyond its strength in the present stage. A shorter step would
    /// have found that earlier: the largest tension may lie within a step.
    fn overloads_bond(&self) -> bool {
        self.h * self.omega() > 1e-6
            && self.pairs.iter().any(|pair| {
                let used = |bond: &crate::contact::pair::Bond| {
                    bond.overload(&pair.law, pair.normal_force, pair.shear_force.norm())
                };
                let pair_history = &self.pair_histories[pair.pair_history];
                // a bond overloaded from the start breaks at once: no shorter step changes that
                pair.bond.as_ref().is_some_and(|bond| used(bond) > OVERLOAD)
                    && pair_history.overload() <= 0.0
            })
    }

    /// Largest error of the embedded method relative to what is allowed for the rock (1/s).
    fn error(&self, control: &Control) -> f64 {
        let tableau = control.tableau;
        let allowed_m_s: Vec<f64> =
            self.members.iter().map(|member| member.allowed_m_s(control.impact)).collect();
        let mut worst2 = 0.0f64;
        let mut omegas: Vec<f64> =
            self.members.iter().map(|member| member.omega(self.terrain)).collect();
        for (pair_history, rates) in self
            .pair_histories
            .iter()
            .zip(&self.pair_rates)
            .filter(|(pair_history, _)| pair_history.is_held())
        {
            for k in [pair_history.a as usize, pair_history.b as usize] {
                omegas[k] = omegas[k].max(pair_history.law.omega_rad_s());
            }
            // error of the shear stretch (m/s as a rate), times ω to compare with an acceleration
            let drift = tableau.embedded_difference(rates, |rate| *rate);
            let [a, b] = [pair_history.a, pair_history.b].map(|k| allowed_m_s[k as usize]);
            let by = 1.0 / a.min(b);
            worst2 =
                worst2.max(drift.norm_squared() * (pair_history.law.omega_rad_s() * by).powi(2));
        }
        for ((member, omega), allowed_m_s) in self.members.iter().zip(&omegas).zip(&allowed_m_s) {
            let (IslandBody { state, body, .. }, by) = (&**member, 1.0 / allowed_m_s);
            let own2 = step_control::error_rate2(tableau, state, body, (*omega, *allowed_m_s));
            worst2 = worst2.max(own2 * by * by);
        }
        worst2.sqrt()
    }
}
