//! The normal element of a contact: a spring beside a dashpot, without tension.
//!
//! `F = max(0, p_N x + c_N x')` for the penetration `x`; set-valued where the surfaces just touch.
//! The functions below are the whole interface: the force at a motion, the force at the end of an
//! implicit stage and its linear form, the energy of the spring, and the element in the units of an
//! impact's own time.

use super::Law;

/// Stiffness that holds a contact exactly at the surface, over `m/h` (–).
const HOLD_STIFFNESS: f64 = 1e7;
/// Slowest impact that strikes through a loaded contact (–, relative to the speed that its spring
/// could give). An impact that travels through a long row of rocks loads the last contacts slightly
/// before it arrives there.
const STRUCK_SHARE: f64 = 0.1;
/// A damping ratio below this counts as none (–).
const ROUNDING_RATIO: f64 = 1e-9;

/// Spring and dashpot in force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NormalElement {
    /// Stiffness `p_N` (N/m).
    pub(super) p_n: f64,
    /// Damping `c_N` (N s/m).
    pub(super) c_n: f64,
}

impl NormalElement {
    /// None.
    pub(crate) const NONE: Self = Self { p_n: 0.0, c_n: 0.0 };

    /// Force of spring and dashpot at a penetration (m) and a speed of separation (m/s), with
    /// tension (N): `p_N x − c_N s`.
    #[inline]
    pub(crate) fn bilateral_force(&self, penetration: f64, apart_m_s: f64) -> f64 {
        self.p_n * penetration - self.c_n * apart_m_s
    }

    /// The force without tension (N), ≥ 0.
    #[inline]
    pub(crate) fn force(&self, penetration: f64, apart_m_s: f64) -> f64 {
        self.bilateral_force(penetration, apart_m_s).max(0.0)
    }

    /// Force (N) at the end of a stage of length `h` (s), without tension, set-valued where the
    /// surfaces just touch. `vn` is the normal speed of separation without this force (m/s), `m`
    /// the mass that it moves (kg).
    #[inline]
    pub(crate) fn stage_force(&self, penetration: f64, vn: f64, m: f64, h: f64) -> f64 {
        let Self { p_n, c_n } = *self;
        let reached = penetration - h * vn;
        let force = (p_n * reached - c_n * vn) / (1.0 + (p_n * h + c_n) * h / m);
        if force <= 0.0 {
            0.0
        } else if reached - h * h * force / m < 0.0 {
            // the dashpot alone would keep the rock out: the force that holds it exactly at the
            // surface
            (reached * m / (h * h)).max(0.0)
        } else {
            force
        }
    }

    /// The force as a linear function of the normal speed at the end of a stage of length `h` (s).
    /// The mode of the contact (open, pressed, or held exactly at the surface) follows from a
    /// penetration at the stage's base (m) and a force (N).
    pub(crate) fn line(
        &self,
        (penetration, normal_force): (f64, f64),
        m: f64,
        h: f64,
    ) -> NormalLine {
        let b = self.p_n * h + self.c_n;
        if normal_force <= 0.0 {
            return NormalLine { a: 0.0, b: 0.0 };
        }
        let speed = (self.p_n * penetration - normal_force) / b;
        if penetration - h * speed < 0.0 {
            // the force is less than that of spring and dashpot: it holds the rock at the surface
            let b = HOLD_STIFFNESS * m / h;
            return NormalLine { a: b * penetration / h, b };
        }
        NormalLine { a: self.p_n * penetration, b }
    }

    /// The same for a bond, which also carries tension.
    #[inline]
    pub(crate) fn bond(&self, penetration: f64, h: f64) -> NormalLine {
        NormalLine { a: self.p_n * penetration, b: self.p_n * h + self.c_n }
    }

    /// The element of a patch of stiffness `gain2 = |a|²` (–) whose dashpot takes `share` of its
    /// own (–), see [`Law::of_patch`].
    #[inline]
    pub(crate) fn of_patch(&self, gain2: f64, share: f64) -> Self {
        Self { p_n: self.p_n * gain2, c_n: self.c_n * (gain2.sqrt() * share) }
    }

    /// Energy in the spring (J).
    #[inline]
    pub(crate) fn stored_j(&self, penetration: f64) -> f64 {
        0.5 * self.p_n * penetration * penetration
    }

    /// Whether its dashpot is noticeable for a mass (kg): for a restitution of 1 it has only the
    /// rounding error of its bisection.
    #[inline]
    pub(crate) fn is_damped(&self, m: f64) -> bool {
        self.c_n * self.c_n > (2.0 * ROUNDING_RATIO).powi(2) * self.p_n * m
    }

    /// Power dissipated at a penetration (m) and a speed of separation (m/s), ≥ 0 (W): `c_N s²`
    /// while the contact pushes, and all that its spring gives back, `p_N x s`, if it separates
    /// faster than spring and dashpot can follow.
    #[inline]
    pub(crate) fn dissipating_w(&self, penetration: f64, apart_m_s: f64) -> f64 {
        if self.bilateral_force(penetration, apart_m_s) > 0.0 {
            self.c_n * apart_m_s * apart_m_s
        } else {
            self.p_n * penetration * apart_m_s.max(0.0)
        }
    }

    /// Power stored in the spring (W).
    #[inline]
    pub(crate) fn storing_w(&self, penetration: f64, closing_m_s: f64) -> f64 {
        self.p_n * penetration * closing_m_s
    }

    /// Stiffness of a patch of relative stiffness `scale` (–), the unit of stiffness of its impact
    /// (N/m).
    #[inline]
    pub(crate) fn stiffness_n_m(&self, scale: f64) -> f64 {
        self.p_n * scale
    }

    /// Damping of a patch of relative stiffness `scale` (–) in a given unit (N s/m).
    #[inline]
    pub(crate) fn damping_over(&self, scale: f64, unit_n_s_m: f64) -> f64 {
        self.c_n * scale.sqrt() / unit_n_s_m
    }

    /// Damping ratio `ζ = c_N/(2 √(p_N m))` (–) for a mass (kg).
    #[inline]
    pub(crate) fn damping_ratio(&self, m: f64) -> f64 {
        0.5 * self.c_n / (self.p_n * m).sqrt()
    }

    /// The element in a step of fixed length `dt` (s).
    pub(crate) fn over_step(&self, dt: f64) -> FixedStepNormal {
        FixedStepNormal { spring: self.p_n, damper: self.c_n / dt }
    }
}

impl Law {
    /// The normal element of an impact, or that of one too slow to rebound (`captured`).
    #[inline]
    pub(crate) fn normal(&self, captured: bool) -> NormalElement {
        NormalElement { p_n: self.p_n, c_n: if captured { self.c_n_captured } else { self.c_n } }
    }

    /// Whether a captured contact with a force (N) and a speed of approach (m/s) is struck through:
    /// faster than the capture speed, and not much slower than the speed `F/(m ω)` that its
    /// compressed spring could give. A slower impact does not open a loaded contact, and cannot be
    /// told from the vibration of a light rock under a heavy one.
    ///
    /// `v ≥ v_capture` and `m ω v ≥ STRUCK_SHARE (F − c v)`, with `m ω = p_N/ω`.
    pub(crate) fn is_struck_through(&self, normal_force: f64, approach_m_s: f64) -> bool {
        let spring_n = normal_force - self.c_n_captured * approach_m_s;
        approach_m_s >= self.capture_m_s
            && approach_m_s * self.p_n / self.omega >= STRUCK_SHARE * spring_n
    }

    /// The normal element of a fixed step of length `dt` (s): without dashpots no contact is
    /// captured.
    pub(crate) fn normal_over_step(&self, captured: bool, dt: f64) -> FixedStepNormal {
        self.normal(captured && self.shear.is_damped()).over_step(dt)
    }

    /// Penetration at which the spring alone carries a force (m).
    #[inline]
    pub(crate) fn static_penetration_m(&self, force_n: f64) -> f64 {
        force_n / self.p_n
    }

    /// Whether a contact without force now will have none for `dt` (s): the tension of spring and
    /// dashpot grows as long as `p_N v_n` exceeds `c_N g`. `weight_m_s2` is the component of
    /// gravity along the normal, ≤ 0 (m/s²).
    pub(crate) fn stays_open(&self, apart_m_s: f64, weight_m_s2: f64, dt: f64) -> bool {
        let damping = self.c_n.max(self.c_n_captured);
        self.p_n * (apart_m_s + weight_m_s2 * dt) > -damping * weight_m_s2
    }
}

/// The normal force as a line `F = a − b s` in the normal speed `s` at the stage's end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NormalLine {
    pub(crate) a: f64,
    pub(crate) b: f64,
}

impl NormalLine {
    pub(crate) fn at(&self, speed: f64) -> f64 {
        (self.a - self.b * speed).max(0.0)
    }

    /// Force of a bond for a normal speed `vn` without the bond's own effect (m/s); `inv_m` is the
    /// reciprocal of the mass it moves (1/kg).
    #[inline]
    pub(crate) fn bilateral_force(&self, vn: f64, h: f64, inv_m: f64) -> f64 {
        (self.a - self.b * vn) / (1.0 + self.b * h * inv_m)
    }
}

/// Spring and dashpot over a step of fixed length: force per displacement (N/m).
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct FixedStepNormal {
    spring: f64,
    damper: f64,
}

impl FixedStepNormal {
    /// Force at a penetration `depth` at the step's end and `inside` at its start (m, the latter ≥
    /// 0): the dashpot acts only from the touch on.
    #[inline]
    pub(crate) fn force(&self, depth: f64, inside: f64) -> f64 {
        self.spring * depth + self.damper * (depth - inside)
    }

    /// Derivative of the force with respect to the displacement (N/m).
    #[inline]
    pub(crate) fn stiffness(&self) -> f64 {
        self.spring + self.damper
    }

    /// Stiffness (N/m) with which a gap (m), negative for an overlap, enters the load: the dashpot
    /// does no work before the touch.
    #[inline]
    pub(crate) fn load_stiffness(&self, is_inside: bool) -> f64 {
        if is_inside { self.spring } else { self.stiffness() }
    }

    /// Energy dissipated by the dashpot from `inside` to `depth` (J).
    pub(crate) fn loss_j(&self, pressed: bool, depth: f64, inside: f64) -> f64 {
        if pressed {
            self.damper * (depth - inside).powi(2)
        } else if self.damper > 0.0 {
            // separated before the spring is back at its length: the dashpot dissipates the rest
            -self.stored_more_j(depth.max(0.0), inside)
        } else {
            0.0
        }
    }

    /// Increase of the spring's energy from `inside` to `depth` (m, J).
    pub(crate) fn stored_more_j(&self, depth: f64, inside: f64) -> f64 {
        0.5 * self.spring * (depth.powi(2) - inside.powi(2))
    }
}
