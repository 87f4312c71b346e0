//! A trial step on a plane.
//!
//! A state has fourteen numbers: displacement, velocity, spin, shear stretch and rolling stretch,
//! in the frame of two tangents and the normal. Normal force and friction follow in closed form
//! (`stage_force`, `FrictionRolling::solve`), so a stage iterates only over the two sliders.
//!
//! Equations of a stage, with `x*` the state at its base, `h` its length (`γ Δt`) and
//! `v_f = v* + h g`:
//!
//! ```text
//! F  = max(0, (p_N (pen* − h v_fn) − c_N v_fn)/(1 + (p_N h² + c_N h)/m)), set-valued at penetration 0
//! q  = p_s ξ* + κ u₁,    κ = p_s h + c_s,       |q| ≤ μ F         both at the end of the stage,
//! M  = k_r θ* + κ_r ω₁,  κ_r = k_r h + c_r,     |M| ≤ μ_r R F     coupled: `FrictionRolling`
//! v₁ = v_f + h (F n − q)/m,       ω₁ = ω* + h (R n × q − M)/I
//! ξ' = (q − p_s ξ*)/κ,            θ' = (M − k_r θ*)/κ_r
//! ```

use crate::contact::neighbours::Neighbours;
use crate::ground::{Law, NormalElement};
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::contact_frame::{Local, dot, square};
use crate::solver::contact_state::ContactEnvironment;
use crate::solver::friction_rolling::{Compliance, FrictionRolling, SlipState};
use crate::solver::loss::Loss;
use crate::solver::plane_ahead::PlaneStep;
use crate::solver::plane_state::{
    PlaneForces, PlaneState, ROLL, SHEAR, SIZE, SPEED, SPIN, State, WAY, along_at, local_at, slip,
    state_of, stored_j,
};
use crate::solver::step_control::{
    Advance, Control, ONSET, PLACE_ROUNDING, RESOLVED, ROUNDING, StepFailure, TrialStep,
    TryOutcome, find_accepted_step,
};

/// An impact is over after about so many radians of its contact (–): up to there its steps are
/// taken in one call.
const IMPACT_RAD: f64 = 3.5;

/// A step that can be tried with any length.
pub(super) struct PlaneTrial<'a, 'w> {
    /// The step to try next (s).
    pub(super) h: &'a mut f64,
    /// The longest step that misses no feature (s).
    pub(super) limit: f64,
    /// The longest step that misses no feature at any position (s).
    pub(super) usual_s: f64,
    /// Time left for steps without a new contact search (s): the same whatever is left out.
    pub(super) room_s: f64,
    /// Tableau and tolerances.
    pub(super) control: &'a Control,
    pub(super) world: &'a ContactEnvironment<'w>,
    pub(super) law: &'a Law,
    pub(super) plane: &'a mut PlaneState,
    /// Normal spring and dashpot in force.
    pub(super) normal: NormalElement,
    /// Gravity in the frame of the plane (m/s²).
    pub(super) gravity: Local,
    /// Penetration at `start` (m).
    pub(super) penetration: f64,
    /// Energy at the step's start: kinetic, springs and height over `start` (J).
    pub(super) energy: f64,
    /// The same at its end.
    pub(super) energy_at_end: f64,
    /// Distance from `start` within which all features are known, squared (m²).
    pub(super) known_way2: f64,
    /// Features collected around the rock, which certify the plane.
    pub(super) near: &'a Neighbours,
    /// Centre from which displacements are counted (m).
    pub(super) start: Vec3,
    /// The face that it is on.
    pub(super) face: u32,
    /// Modes of shear and rolling found last.
    pub(super) mode: SlipState,
    /// State at the end of the last stage solved.
    pub(super) end: State,
    /// Forces there (N, N m).
    pub(super) forces: PlaneForces,
    /// Energy of the springs there (J).
    pub(super) stored: f64,
    /// Stages solved so far.
    pub(super) solved: u64,
}

/// Constants of all stages of a step of one length.
struct StageConstants {
    /// Length of a stage (s).
    hh: f64,
    compliance: Compliance,
    /// Reciprocals of the coefficients of shear and rolling spring (m/(N s), 1/(N m s)).
    over_s: f64,
    over_r: f64,
}

impl StageConstants {
    #[inline]
    fn new(body: &Body, law: &Law, hh: f64) -> Self {
        let compliance = Compliance::of(body, law, hh);
        let over_r = if compliance.kappa_r > 0.0 { 1.0 / compliance.kappa_r } else { 0.0 };
        Self { hh, over_s: 1.0 / compliance.kappa, over_r, compliance }
    }
}

impl PlaneTrial<'_, '_> {
    /// Solves implicit stage `i` of a step of length `dt`.
    #[inline]
    fn stage(&mut self, i: usize, dt: f64, constants: &StageConstants) {
        let (body, law, tableau) = (&self.world.body, self.law, self.control.tableau);
        let hh = constants.hh;
        // x + h Σ a_ij f_j
        let mut base = self.plane.state;
        for (rate, a) in self.plane.rates.iter().zip(tableau.a[i]) {
            for (base, rate) in base.iter_mut().zip(rate) {
                *base += rate * (dt * a);
            }
        }
        let spin = local_at(&base, SPIN);
        let speed = [0, 1, 2].map(|k| base[SPEED + k] + self.gravity[k] * hh);
        let penetration = self.penetration - base[WAY + 2];
        // Kelvin–Voigt element at the stage's end, never pulling; see the law
        let normal_force = self.normal.stage_force(penetration, speed[2], body.mass, hh);
        let (mut shear_force, mut rolling_moment) = ([0.0; 2], [0.0; 3]);
        if normal_force > 0.0 {
            let (slip, compliance) = (slip(body, speed, spin), &constants.compliance);
            // trial forces: those of springs and dashpots without sliding
            let a = [0, 1]
                .map(|k| law.shear.spring_force(base[SHEAR + k]) + slip[k] * compliance.kappa);
            let d = [0, 1, 2]
                .map(|k| law.rolling.spring_force(base[ROLL + k]) + spin[k] * compliance.kappa_r);
            let caps = law.limits().caps(normal_force);
            (shear_force, rolling_moment) =
                FrictionRolling { compliance, a, d, caps }.solve(&mut self.mode);
        }
        let forces = PlaneForces { normal_force, shear_force, rolling_moment, closed: true };
        let (dv, dw) = forces.accelerations(body);
        let v = [0, 1, 2].map(|k| speed[k] + dv[k] * hh);
        let dv = [0, 1, 2].map(|k| self.gravity[k] + dv[k]);
        let shear_rate = [0, 1]
            .map(|k| (shear_force[k] - law.shear.spring_force(base[SHEAR + k])) * constants.over_s);
        let roll_rate = [0, 1, 2].map(|k| {
            (rolling_moment[k] - law.rolling.spring_force(base[ROLL + k])) * constants.over_r
        });
        let rate = state_of([v, dv, dw], shear_rate, roll_rate);
        // stiffly accurate: the end of the last stage is that of the step
        self.end = std::array::from_fn(|k| base[k] + rate[k] * hh);
        let (speed, spin) = (local_at(&self.end, SPEED), local_at(&self.end, SPIN));
        self.plane.rates[i] = rate;
        self.plane.losses[i] = forces.losses(slip(body, speed, spin), (speed[2], spin), shear_rate);
        self.forces = forces;
        self.solved += 1;
    }

    /// Why the stage's end is rejected, if it is: the rock must stay over the face and touch
    /// nothing else.
    ///
    /// Cheapest test first: a distance, a certificate for the whole margin, then tests of the
    /// position itself.
    #[inline]
    fn rejection(&self, dt: f64) -> Option<TryOutcome> {
        let centre = self.start + self.plane.frame.out_local(local_at(&self.end, WAY));
        if square(local_at(&self.end, WAY)) > self.known_way2 && !self.near.covers(&centre) {
            return Some(TryOutcome::OutOfDomain);
        }
        if self.near.plane() == Some(self.face) {
            return None;
        }
        if !self.near.is_foot_on(self.face, &centre) {
            return Some(TryOutcome::OutOfDomain);
        }
        let reach = self.world.body.radius;
        if self.near.is_only_contact(self.world.terrain, self.face, (&centre, reach)) {
            return None;
        }
        // it runs into something, whose onset must be resolved: the step is shortened first
        Some(if dt * self.law.omega_rad_s() > ONSET {
            TryOutcome::NotConverged
        } else {
            TryOutcome::OutOfDomain
        })
    }

    /// Local error relative to the tolerance.
    #[inline]
    fn error(&self, dt: f64) -> f64 {
        let tableau = self.control.tableau;
        // rates of the stages with the error weights: the embedded method's difference over the step's length
        let mut error = [0.0; SIZE];
        for (rate, weight) in self.plane.rates[..tableau.stages].iter().zip(tableau.error) {
            for (error, rate) in error.iter_mut().zip(rate) {
                *error += rate * weight;
            }
        }
        let omega2 = self.law.omega_rad_s() * self.law.omega_rad_s();
        let worst2 = (square(local_at(&error, WAY)).max(square(along_at(&error, SHEAR))) * omega2)
            .max(square(local_at(&error, SPEED)))
            .max(square(local_at(&error, SPIN)) * self.world.body.radius.powi(2));
        dt * worst2.sqrt() / self.control.tolerance
    }

    /// Whether the step, as it went, has touched nothing but the plane.
    #[inline]
    fn touches_plane_only(&self, dt: f64) -> bool {
        if dt <= self.usual_s {
            return true;
        }
        let (begun, frame) = (&self.plane.state, &self.plane.frame);
        let start = self.start + frame.out_local(local_at(begun, WAY));
        let since = |at: usize| {
            let (to, from) = (local_at(&self.end, at), local_at(begun, at));
            frame.out_local([0, 1, 2].map(|k| to[k] - from[k]))
        };
        let step = PlaneStep { face: self.face, n: frame.out_local([0.0, 0.0, 1.0]), start };
        step.touches_plane_only((self.world, self.near), (&since(WAY), &since(SPEED)), dt)
    }

    /// Kinetic energy, height and springs at the step's end (J).
    #[inline]
    fn motion_and_springs_j(&self) -> f64 {
        let (body, end) = (&self.world.body, &self.end);
        let (speed2, spin2) = (square(local_at(end, SPEED)), square(local_at(end, SPIN)));
        let motion = 0.5 * (body.mass * speed2 + body.inertia * spin2);
        motion + self.stored - body.mass * dot(self.gravity, local_at(end, WAY))
    }

    /// Whether that exceeds the energy at the step's start by more than the rounding of energies
    /// and of positions times forces.
    #[inline]
    fn gains_energy(&self) -> bool {
        let body = &self.world.body;
        let force = body.mass * body.gravity.norm() + self.forces.normal_force;
        let rounding_j = ROUNDING * self.energy.abs() + PLACE_ROUNDING * body.radius * force;
        self.energy_at_end > self.energy + rounding_j
    }

    /// Takes steps until the rock is free, an impact would be over, or the features around are no
    /// longer known. Returns the failure that stopped it before, if any.
    pub(super) fn take_steps(
        &mut self,
        (h_max, is_tree): (f64, bool),
        done: &mut Advance,
    ) -> Option<StepFailure> {
        // whether a stem still stands must be checked after every step
        let omega = self.law.omega_rad_s();
        let span = if is_tree { 0.0 } else { IMPACT_RAD / omega };
        let (control, mut sum) = (self.control, [0.0; 3]);
        let failure = loop {
            let left = h_max - done.dt;
            let dt = match find_accepted_step(self, control, (left, omega), &mut done.rejected) {
                Ok(dt) => dt,
                Err(failure) => break Some(failure),
            };
            self.accept(dt, &mut sum);
            done.steps += 1;
            done.dt = if dt >= left { h_max } else { done.dt + dt };
            if !self.forces.closed || done.dt >= span.min(h_max) || !self.may_continue(dt) {
                break None;
            }
        };
        done.loss = Loss::on_slope(sum);
        failure
    }

    /// Accepts the step; adds the energies that went into friction, damping and rolling (J) to
    /// `sum`.
    #[inline]
    fn accept(&mut self, dt: f64, sum: &mut Local) {
        let tableau = self.control.tableau;
        for (k, losses) in self.plane.losses[..tableau.stages].iter().enumerate() {
            let weight = dt * tableau.work_weight(k);
            for (sum, loss) in sum.iter_mut().zip(losses) {
                *sum += weight * loss;
            }
        }
        self.energy = self.energy_at_end;
        let last = tableau.stages - 1;
        let plane = &mut *self.plane;
        (plane.rates[0], plane.losses[0]) = (plane.rates[last], plane.losses[last]);
        plane.state = self.end;
    }

    /// Whether the next step stays where all features are known, and within the longest step
    /// allowed.
    ///
    /// Also bounds the time without a contact search, in the same way for every mesh: with one
    /// triangle or a thousand in the plane the steps are the same.
    #[inline]
    fn may_continue(&mut self, dt: f64) -> bool {
        self.room_s -= dt;
        let (state, h) = (&self.plane.state, *self.h);
        let ahead = [0, 1, 2].map(|k| state[WAY + k] + state[SPEED + k] * h);
        h <= self.room_s && square(ahead) < self.known_way2
    }
}

impl TrialStep for PlaneTrial<'_, '_> {
    fn h(&mut self) -> &mut f64 {
        self.h
    }

    fn limit(&mut self) -> f64 {
        self.limit
    }

    fn try_step(&mut self, dt: f64) -> TryOutcome {
        let constants =
            StageConstants::new(&self.world.body, self.law, self.control.tableau.diagonal * dt);
        for i in 1..self.control.tableau.stages {
            self.stage(i, dt, &constants);
            if let Some(rejection) = self.rejection(dt) {
                return rejection;
            }
        }
        let error = self.error(dt);
        if error > 1.0 || error.is_nan() {
            return TryOutcome::Error(error);
        }
        let penetration = (self.penetration - self.end[WAY + 2]).max(0.0);
        self.forces.closed = self.forces.normal_force > 0.0 || penetration > 0.0;
        self.stored =
            if self.forces.closed { stored_j(self.law, penetration, &self.end) } else { 0.0 };
        self.energy_at_end = self.motion_and_springs_j();
        if dt * self.law.omega_rad_s() > RESOLVED && self.gains_energy() {
            return TryOutcome::EnergyGain;
        }
        if self.touches_plane_only(dt) {
            TryOutcome::Error(error)
        } else {
            TryOutcome::Cut(self.usual_s / dt)
        }
    }
}
