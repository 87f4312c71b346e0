//! An impact on one plane, with gravity.
//!
//! Units: mass `m`, approach speed `v_n`, time `1/ω`, length `v_n/ω`; spin times radius is a speed.
//! Frame: two tangents and the normal. The normal motion is a closed form and is found first; then
//! the tangential motion under its force; then the free motion until the penetration is zero.

mod blow_table;
mod passage;
mod straight;

use super::ImpactEffort;
use super::integrate::{ForcedFlow, IntegrationSpan, run};
use super::normal_motion::{Exit, NormalMotion};
use super::sliders::{ShearFlow, ShearRollingFlow, SliderElement};
use crate::ground::Law;
use crate::math;
use crate::rock::Vec3;
use crate::solver::body::Body;
use crate::solver::contact_frame::{Along, Local, dot, square};
use crate::solver::loss::{Loss, scale_to_total};

pub(crate) use blow_table::BlowTable;
pub(crate) use passage::{InitialDeformation, NormalPassage};
pub(crate) use straight::blow_along_a_line;

/// From this tolerance on a shorter series of the force is accurate enough (–).
const COARSE: f64 = 1e-6;
/// Local error of one step over the tolerance (–): the few steps of an impact then stay within
/// about the tolerance.
pub(in crate::solver) const LOCAL_ERROR: f64 = 0.3;
/// The same along a plane, where steps contain no switching points (–).
const SMOOTH: f64 = 0.6;
/// First step along a plane at a local error of 1 (1/ω): that of order 5 is about (h/this)⁵.
const FIRST: f64 = 2.5;

/// Impacts of one rock on one ground: all that is constant from impact to impact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    body: Body,
    /// `√(p_N/m)` (rad/s).
    omega: f64,
    oscillator: NormalMotion,
    shear: SliderElement,
    rolling: SliderElement,
    tolerance: f64,
}

/// Motion after an impact, where the penetration is zero again, or after a part of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rebound {
    /// Time since first contact (s).
    pub(crate) time_s: f64,
    /// Displacement of the centre (m).
    pub(crate) shift_m: Vec3,
    /// Velocity (m/s).
    pub(crate) velocity_m_s: Vec3,
    /// Spin (rad/s).
    pub(crate) spin_rad_s: Vec3,
    /// Energy lost by kind (J), each ≥ 0: together exactly the energy before less that after,
    /// height included.
    pub(crate) loss: Loss,
    /// Remaining deformation of the contact, if only a part of the impact was integrated.
    pub(crate) pressed: Option<InitialDeformation>,
    /// Steps of the integration.
    pub(crate) effort: ImpactEffort,
}

/// Motion along the plane and spin, with their losses, in units of mass, radius, approach speed and
/// `1/ω`. Slip is `u = v + R n × ω`: in the frame `u = (v_s − R ω_t, v_t + R ω_s)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct TangentialMotion {
    pub(super) v: Along,
    pub(super) w: Local,
    /// Displacement.
    pub(super) way: Along,
    /// Remaining stretches of the springs of shear and rolling, as speeds.
    pub(super) shear: Along,
    pub(super) roll: Local,
    /// Lost by slipping, shear and rolling.
    pub(super) lost: Local,
}

impl Plane {
    /// Prepares the impacts of `body` on a ground of `law`; `tolerance` is the local error allowed
    /// of a step (–, relative to the speed of the impact).
    pub(crate) fn new(body: &Body, law: &Law, tolerance: f64) -> Self {
        Self::of_patch(body, law, (false, 1.0), tolerance)
    }

    /// The same of a patch, captured or not, with its stiffness scale (–).
    pub(in crate::solver::impact) fn of_patch(
        body: &Body,
        law: &Law,
        (captured, scale): (bool, f64),
        tolerance: f64,
    ) -> Self {
        // the dashpot of a patch is c_N |a| and its stiffness p_N |a|², so ζ = c_N/(2 √(p_N m)) is
        // that of a single point
        let normal = law.normal(captured);
        let stiffness = normal.stiffness_n_m(scale);
        Self {
            body: *body,
            omega: (stiffness / body.mass).sqrt(),
            oscillator: NormalMotion::new(normal.damping_ratio(body.mass)),
            shear: SliderElement::shear(body, law, stiffness),
            rolling: SliderElement::rolling(body, law, stiffness),
            tolerance,
        }
    }

    /// Damping ratio of the normal motion (–), and the shear element, of one point of contact.
    fn elements((body, law): (&Body, &Law), captured: bool) -> (f64, SliderElement) {
        let normal = law.normal(captured);
        let shear = SliderElement::shear(body, law, normal.stiffness_n_m(1.0));
        (normal.damping_ratio(body.mass), shear)
    }

    /// Integrates the impact of a rock that has just touched the plane with unit normal `n`, with
    /// velocity `v` (m/s), `n·v < 0`, and spin `w` (rad/s), until it has left the plane; `None` if
    /// gravity keeps it in contact.
    pub(crate) fn follow(&self, n: &Vec3, v: &Vec3, w: &Vec3) -> Option<Rebound> {
        let passage = self.passage(n, v, 0.0)?;
        Some(self.pass(&passage, (v, w), &InitialDeformation::NONE))
    }

    /// The tangential motion and the spin, until the penetration is zero.
    #[inline]
    fn tangential_motion(
        &self,
        start: &ImpactStart,
        exit: &Exit,
        effort: &mut ImpactEffort,
    ) -> TangentialMotion {
        let mut end = if self.rolling.is_on() {
            self.integrate_rolling(start, exit.lift_off, effort)
        } else if self.shear.is_on() {
            self.integrate_shear(start, exit.lift_off, effort)
        } else {
            let t = exit.lift_off;
            let way = [0, 1].map(|k| (start.v[k] + 0.5 * start.gravity[k] * t) * t);
            let v = [0, 1].map(|k| start.v[k] + start.gravity[k] * t);
            TangentialMotion { v, w: start.w, way, shear: [0.0; 2], roll: [0.0; 3], lost: [0.0; 3] }
        };
        // after lift-off: free motion along the surface too, until the penetration is 0
        for k in 0..2 {
            let gained = start.gravity[k] * exit.clearing;
            end.way[k] += (end.v[k] + 0.5 * gained) * exit.clearing;
            end.v[k] += gained;
        }
        end
    }

    /// Shear alone: slip and spring are integrated, velocity and spin follow from the impulse.
    ///
    /// Two numbers of slip and two of the spring are integrated; `v` and `ω` follow from the
    /// impulse `J = Σ q dt` alone: `Δv = −J/m`, and the lever `R` turns it into spin.
    fn integrate_shear(
        &self,
        start: &ImpactStart,
        t: f64,
        effort: &mut ImpactEffort,
    ) -> TangentialMotion {
        let turns = self.body.turns();
        let lightness = 1.0 + turns;
        let u = [start.v[0] - start.w[1], start.v[1] + start.w[0]];
        let is_straight = start.gravity.iter().chain(&start.shear).all(|x| *x == 0.0);
        let (y, slipping, ways) = if is_straight && start.leaves {
            let (u, slipping, ways) = self.slips_along_a_line(u, start, t, effort);
            ([u[0], u[1], 0.0, 0.0], slipping, ways)
        } else {
            let flow = ShearFlow { element: self.shear, lightness, gravity: start.gravity };
            let (y, [slipping, ways @ ..]) =
                self.run(&flow, [u[0], u[1], start.shear[0], start.shear[1]], start, t, effort);
            (y, slipping, ways)
        };
        let g = start.gravity;
        // slip without friction, less the actual slip, is the effect of the impulse on the contact
        // point
        let free = [0, 1].map(|k| u[k] + g[k] * t);
        // Impulse over mass, and its time integral.
        let impulse = [0, 1].map(|k| (free[k] - y[k]) / lightness);
        let impulse_integral = [0, 1].map(|k| ((u[k] + 0.5 * g[k] * t) * t - ways[k]) / lightness);
        let way = [0, 1].map(|k| (start.v[k] + 0.5 * g[k] * t) * t - impulse_integral[k]);
        let mut end = TangentialMotion {
            v: [0, 1].map(|k| start.v[k] + g[k] * t - impulse[k]),
            w: [start.w[0] - turns * impulse[1], start.w[1] + turns * impulse[0], start.w[2]],
            way,
            shear: start.end_springs([y[2], y[3]]),
            roll: [0.0; 3],
            lost: [0.0; 3],
        };
        // The work of the shear force: its impulse times the mean slip, less what gravity brought
        // in between.
        let lost = self.limit_energy(start, &mut end);
        end.lost = [slipping.clamp(0.0, lost), 0.0, 0.0];
        end.lost[1] = lost - end.lost[0];
        end
    }

    /// Shear and rolling.
    ///
    /// The rolling moment acts on spin alone, so velocity no longer follows from slip: all ten
    /// numbers are integrated.
    fn integrate_rolling(
        &self,
        start: &ImpactStart,
        t: f64,
        effort: &mut ImpactEffort,
    ) -> TangentialMotion {
        let flow = ShearRollingFlow {
            shear: self.shear,
            rolling: self.rolling,
            turns: self.body.turns(),
            gravity: start.gravity,
        };
        let ([vx, vy], [wx, wy, wz]) = (start.v, start.w);
        let ([sx, sy], [rx, ry, rz]) = (start.shear, start.roll);
        let begin = [vx, vy, wx, wy, wz, sx, sy, rx, ry, rz];
        let (y, [slipping, x, z, rolling, shear]) = self.run(&flow, begin, start, t, effort);
        let mut end = TangentialMotion {
            v: [y[0], y[1]],
            w: [y[2], y[3], y[4]],
            way: [x, z],
            shear: start.end_springs([y[5], y[6]]),
            roll: start.end_springs([y[7], y[8], y[9]]),
            lost: [0.0; 3],
        };
        let lost = self.limit_energy(start, &mut end);
        let [held_shear, held_roll] = self.given_back((&start.shear, &start.roll), &end);
        let slipping = slipping.max(0.0);
        let (shear, rolling) = (shear + held_shear - slipping, rolling + held_roll);
        end.lost = [slipping, shear.max(0.0), rolling.max(0.0)];
        scale_to_total(lost, &mut end.lost);
        end
    }

    #[inline]
    fn run<P: ForcedFlow<N, Q, K>, const N: usize, const Q: usize, const K: usize>(
        &self,
        flow: &P,
        begin: [f64; N],
        start: &ImpactStart,
        length: f64,
        effort: &mut ImpactEffort,
    ) -> ([f64; N], [f64; Q]) {
        let ImpactStart { begin: force, gamma, allowed, .. } = *start;
        let first = FIRST * math::pow(allowed, 0.2);
        let span = IntegrationSpan {
            oscillator: self.oscillator,
            begin: force,
            gamma,
            length,
            first,
            allowed,
        };
        if start.allowed >= COARSE {
            run::<P, N, Q, K, 9>(flow, begin, &span, effort)
        } else {
            run::<P, N, Q, K, 17>(flow, begin, &span, effort)
        }
    }

    /// Energy returned by the springs of shear and rolling from these initial stretches.
    fn given_back(&self, (shear, roll): (&Along, &Local), end: &TangentialMotion) -> [f64; 2] {
        let [shear, kept_shear] = [shear, &end.shear].map(|s| self.shear.stored(s));
        let [roll, kept_roll] = [roll, &end.roll].map(|s| self.rolling.stored(s));
        [shear - kept_shear, roll - kept_roll]
    }

    /// Tangential loss: energy before, plus the energy returned by springs and the work of gravity,
    /// less the energy after. If the integration error would make that a gain, the motion after is
    /// slowed accordingly.
    fn limit_energy(&self, start: &ImpactStart, end: &mut TangentialMotion) -> f64 {
        let over = 1.0 / self.body.turns();
        let energy = |v: Along, w: Local| 0.5 * (square(v) + over * square(w));
        let before = energy(start.v, start.w) + dot(start.gravity, end.way);
        let given_back = self.given_back((&start.shear, &start.roll), end);
        let before = before + given_back.iter().sum::<f64>();
        let after = energy(end.v, end.w);
        if after > before {
            let slower = (before.max(0.0) / after).sqrt();
            (end.v, end.w) = (end.v.map(|v| v * slower), end.w.map(|w| w * slower));
        }
        (before - energy(end.v, end.w)).max(0.0)
    }
}

/// Start of an impact, in units of radius, speed and `1/ω`.
struct ImpactStart {
    v: Along,
    w: Local,
    /// Stretches of the springs of shear and rolling, as the velocities at which their dashpots
    /// would give the same force.
    shear: Along,
    roll: Local,
    gravity: Along,
    /// Gravity into the plane.
    gamma: f64,
    /// Normal force and its rate.
    begin: [f64; 2],
    /// Whether the rock is followed until it leaves: the energy of the springs is lost then.
    leaves: bool,
    /// Local error allowed.
    allowed: f64,
}

impl ImpactStart {
    /// Stretches of the springs at the end.
    fn end_springs<const N: usize>(&self, s: [f64; N]) -> [f64; N] {
        if self.leaves { [0.0; N] } else { s }
    }
}
