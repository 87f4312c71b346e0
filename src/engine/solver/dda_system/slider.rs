//! The friction element of shear and rolling.
//!
//! ```text
//! sticks:  q = k (ξ + Δ) + (c/Δt) Δ,        Δ the displacement of the contact point over the step
//! slides:  q = cap · e,                     e the direction of the sticking force
//! end:     ξ₁ = (q + (c/Δt) ξ)/(k + c/Δt)   the stretch at which spring and dashpot carry q
//! ```
//!
//! Sign: `q` acts against the sphere's motion.

use crate::ground::FrictionElement;
use crate::rock::Vec3;

/// Change of a friction force, relative to its cap, at which it has converged (–).
const CONVERGED: f64 = 1e-5;

/// Change of a contact state, ordered by the cost of its consequence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Change {
    /// Nothing.
    None,
    /// A friction force: the load changes.
    Load,
    /// Open, sliding or sticking: the matrix changes.
    Mode,
}

/// A spring beside a dashpot, in series with a slider: shear (m, N) or rolling (rad, N m).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct DdaSlider {
    /// Stretch at the step's start.
    pub stretch: Vec3,
    /// Stiffness.
    pub spring: f64,
    /// Damping over the step's length.
    pub damper: f64,
    /// Displacement per unit of its force over the step.
    pub compliance: f64,
    /// Whether it slides.
    pub slides: bool,
    /// Force while it slides.
    pub friction: Vec3,
}

impl DdaSlider {
    /// A friction element over a step of length `dt` (s), at rest.
    pub(crate) fn new(element: &FrictionElement, dt: f64, compliance: f64) -> Self {
        let [spring, damper] = element.over_step(dt);
        Self { spring, damper, compliance, ..Self::default() }
    }

    /// Force after `displacement` while it sticks.
    pub(crate) fn sticking(&self, displacement: &Vec3) -> Vec3 {
        self.stretch * self.spring + displacement * (self.spring + self.damper)
    }

    /// Stiffness while it `acts` (N/m): 0 while it slides.
    pub(crate) fn stiffness(&self, acts: bool) -> f64 {
        if acts && !self.slides { self.spring + self.damper } else { 0.0 }
    }

    pub(crate) fn force(&self, displacement: &Vec3) -> Vec3 {
        if self.slides { self.friction } else { self.sticking(displacement) }
    }

    /// Stretch at the step's end under a force.
    pub(crate) fn stretch_after(&self, force: &Vec3) -> Vec3 {
        (force + self.stretch * self.damper) / (self.spring + self.damper)
    }

    /// Updates the state: it slides where the sticking force exceeds the cap, in that force's
    /// direction.
    ///
    /// `displacement` was found with the force `last_force`. The effect of that force is removed
    /// first, which makes the iteration converge: the slip that is left by friction itself says
    /// little about its direction.
    ///
    /// `displacement + last_force · compliance` is the displacement of the contact point without
    /// any force of this element; from there the sticking force is
    /// `(k ξ + k_eff Δ₀)/(1 + k_eff · compliance)`, `k_eff = k + c/Δt`: the element's own force
    /// reduces the displacement.
    pub(crate) fn update_state(
        &mut self,
        displacement: &Vec3,
        last_force: &Vec3,
        cap: f64,
    ) -> Change {
        let stiff = 1.0 + (self.spring + self.damper) * self.compliance;
        let sticking_force = self.sticking(&(displacement + last_force * self.compliance)) / stiff;
        let size = sticking_force.norm();
        // at the cap itself rounding must not switch the state to and fro
        let least = if self.slides { cap * (1.0 - CONVERGED) } else { cap };
        let slides = cap <= 0.0 || size > least;
        let friction =
            if slides && size > 0.0 { sticking_force * (cap / size) } else { Vec3::zeros() };
        let change = if slides != self.slides {
            Change::Mode
        } else if slides && (friction - self.friction).norm() > CONVERGED * cap {
            Change::Load
        } else {
            return Change::None;
        };
        (self.slides, self.friction) = (slides, friction);
        change
    }

    /// The update as printed in the paper: friction is `before`, from the end of the last step, and
    /// acts against the displacement of the step until that reverses.
    pub(crate) fn update_state_as_printed(
        &mut self,
        displacement: &Vec3,
        cap: f64,
        before: f64,
    ) -> Change {
        if !self.slides && self.sticking(displacement).norm() > cap {
            (self.slides, self.friction) = (true, unit_or_zero(displacement) * before);
            Change::Mode
        } else if self.slides && displacement.dot(&self.friction) < 0.0 {
            (self.slides, self.friction) = (false, Vec3::zeros());
            Change::Mode
        } else {
            Change::None
        }
    }

    /// Energy that slider and dashpot take over `displacement` at `force`.
    ///
    /// Work of the slider is force times its slip, which is displacement less growth of the
    /// stretch; the dashpot takes `c/Δt` times the square of that growth.
    pub(crate) fn loss(&self, displacement: &Vec3, force: &Vec3) -> (f64, f64) {
        let stretched = self.stretch_after(force) - self.stretch;
        (force.dot(&(displacement - stretched)), self.damper * stretched.norm_squared())
    }

    /// Increase of the spring's energy from the step's start to `force` (J).
    pub(crate) fn stored_more_j(&self, force: &Vec3) -> f64 {
        0.5 * self.spring * (self.stretch_after(force).norm_squared() - self.stretch.norm_squared())
    }
}

/// The direction of `x`, or zero.
pub(crate) fn unit_or_zero(x: &Vec3) -> Vec3 {
    x.try_normalize(0.0).unwrap_or_default()
}
