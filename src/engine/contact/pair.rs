//! The contact of two rocks, its history, and the bond that may join them.
//!
//! Two spheres have one nearest point, so a pair is one contact, never a patch. Its normal `n`
//! points from `b` to `a`, its gap is `λ = |c_a − c_b| − R_a − R_b` (m, negative when pressed in);
//! forces named here act on `a`, their opposites on `b`. Bonds follow Potyondy and Cundall (Int. J.
//! Rock Mech. Min. Sci. 41, 2004, parallel bond) without its moments: a bond carries normal and
//! shear force, but does not resist bending or twist.

use crate::ground::{Law, clamp_norm};
use crate::groups::Groups;
use crate::rock::Vec3;
use std::f64::consts::PI;

/// Unit normal from sphere `b` to sphere `a` and the distance of their centres (m). For coincident
/// centres the normal is vertical, so that the result is the same on every machine.
#[inline]
pub fn normal_and_distance(a: &Vec3, b: &Vec3) -> (Vec3, f64) {
    let off = a - b;
    let distance = off.norm();
    if distance > 0.0 { (off / distance, distance) } else { (Vec3::z(), 0.0) }
}

/// Time of contact (s) from now of two spheres in free flight: under the same gravity their
/// relative motion is a straight line, `|d + u t| = R_a + R_b`.
///
/// `offset` is `d = c_a − c_b` (m), `velocity` is `u = v_a − v_b` (m/s), `reach` the sum of the radii
/// (m). Spheres that touch already and approach collide at 0; those that separate do not collide.
pub fn collision_time_s(offset: &Vec3, velocity: &Vec3, reach: f64) -> Option<f64> {
    let approach = -offset.dot(velocity);
    let speed2 = velocity.norm_squared();
    // d(|d + u t|²)/dt = 2 d·u at t = 0: if it is not negative, the distance grows for ever on a
    // straight relative path
    if approach <= 0.0 || speed2 == 0.0 {
        return None;
    }
    // |d|² − reach² as a product: the difference of squares would cost the digits of a small gap
    let distance = offset.norm();
    let outside = (distance - reach) * (distance + reach);
    // |u|² t² − 2 approach t + outside = 0; the smaller root is outside/(approach + √…), which keeps
    // the digits of a small gap, while (approach − √…)/|u|² would lose them
    let root2 = approach * approach - speed2 * outside;
    if outside <= 0.0 {
        return Some(0.0);
    }
    (root2 >= 0.0).then(|| outside / (approach + root2.sqrt()))
}

/// Strength of the bonds between two rocks of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondStrength {
    /// Tensile strength of a bond (Pa), 0 or more.
    pub tensile_pa: f64,
    /// Cohesion (Pa), 0 or more: the shear strength without normal stress, `c` of Mohr–Coulomb's `τ
    /// = c + σ tan φ`.
    pub cohesion_pa: f64,
}

impl BondStrength {
    /// Whether any strength is positive, so that there are bonds.
    pub fn is_some(&self) -> bool {
        self.tensile_pa > 0.0 || self.cohesion_pa > 0.0
    }
}

/// A bond between two rocks: Mohr–Coulomb with a tension cut-off over a disc.
///
/// Brittle: it breaks at once and never forms again. The energy that its springs held beyond
/// friction is lost then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bond {
    /// Largest tensile force (N): `σ_t A`.
    pub tension_n: f64,
    /// Largest shear force without normal force (N): `c A`.
    pub shear_n: f64,
    /// Distance of the centres without force (m): that at the start, so that bonded rocks begin
    /// without stress.
    pub length_m: f64,
}

impl Bond {
    /// The bond of two rocks whose smaller radius is `radius_m`, at a distance of `length_m`. Its
    /// disc has the smaller radius: `A = π R²`, the whole section of the smaller rock.
    pub fn new(strength: &BondStrength, radius_m: f64, length_m: f64) -> Self {
        let area = PI * radius_m * radius_m;
        Self {
            tension_n: strength.tensile_pa * area,
            shear_n: strength.cohesion_pa * area,
            length_m,
        }
    }

    /// By how much a load exceeds the strength, relative to it (–); 0 or less while the bond holds.
    /// `normal_force` is positive in compression and negative in tension, `shear_force` the size of
    /// the shear force (both N), `law` that of the two rocks, for its friction.
    ///
    /// Tension: `−F ≤ σ_t A`. Shear: `|q| ≤ max(0, c A + F tan φ)`, so that pressure strengthens
    /// and tension weakens. The larger of both overloads counts; a step with a large overload is
    /// shortened, so that the moment of breaking does not depend on its length.
    pub fn overload(&self, law: &Law, normal_force: f64, shear_force: f64) -> f64 {
        let excess = |load: f64, most: f64| {
            if load <= most { 0.0 } else { (load - most) / most.max(f64::MIN_POSITIVE) }
        };
        excess(-normal_force, self.tension_n)
            .max(excess(shear_force, (self.shear_n + law.shear.cap(normal_force)).max(0.0)))
    }
}

/// The history of the contact of two rocks.
///
/// In the frame of both rocks: if the pair rotates as a whole, `n` and `shear` rotate with it.
#[derive(Debug, Clone, Copy)]
pub struct PairHistory {
    /// The rock with the smaller number …
    pub a: u32,
    /// … and the other.
    pub b: u32,
    /// The contact law of the two.
    pub law: Law,
    /// Unit normal from `b` to `a`, to which `shear` is tangent.
    pub n: Vec3,
    /// Stretch of the shear spring (m), of `a` relative to `b`, tangent to `n`; the force on `a` is
    /// `−p_s ξ`.
    pub shear: Vec3,
    /// Normal force at the end of the last step (N).
    pub normal_force: f64,
    /// Shear force at the end of the last step (N).
    pub shear_force: Vec3,
    /// Approached too slowly to rebound.
    pub captured: bool,
    /// Whether it was sliding at the end of the last step.
    pub slides: bool,
    /// Whether the contact was closed at the last accepted step.
    pub closed: bool,
    /// The impact in progress.
    pub impact: PairImpact,
    /// The bond, until it breaks.
    pub bond: Option<Bond>,
}

/// An impact of two rocks in progress.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PairImpact {
    /// Speed of approach (m/s); 0 = there is none.
    pub speed_m_s: f64,
    /// Longest remaining duration (phase of the contact oscillation, rad).
    remaining_rad: f64,
}

/// Longest duration of an impact, on the mesh or between rocks (phase of the contact oscillation,
/// rad). After it the impact is over, or continues as a lasting contact.
pub(crate) const IMPACT_DURATION_RAD: f64 = 20.0;

impl PairImpact {
    /// An impact that begins with a speed of approach (m/s).
    pub fn new(speed_m_s: f64) -> Self {
        Self { speed_m_s, remaining_rad: IMPACT_DURATION_RAD }
    }

    /// The impact after a phase (rad) has passed.
    #[must_use]
    pub fn after(self, rad: f64) -> Self {
        let remaining_rad = self.remaining_rad - rad;
        if remaining_rad > 0.0 { Self { remaining_rad, ..self } } else { Self::default() }
    }
}

impl PairHistory {
    /// Two rocks that do not touch yet.
    pub fn new(a: u32, b: u32, law: Law) -> Self {
        Self {
            a,
            b,
            law,
            n: Vec3::z(),
            shear: Vec3::zeros(),
            normal_force: 0.0,
            shear_force: Vec3::zeros(),
            captured: false,
            slides: false,
            closed: false,
            impact: PairImpact::default(),
            bond: None,
        }
    }

    /// By how much its forces exceed the strength of its bond, relative to it (–); 0 or less
    /// without a bond.
    pub(crate) fn overload(&self) -> f64 {
        let overload =
            |bond: &Bond| bond.overload(&self.law, self.normal_force, self.shear_force.norm());
        self.bond.as_ref().map_or(0.0, overload)
    }

    /// Speed (m/s) of rocks that separate or shear at which their bond reaches the smaller of its
    /// positive strengths; none without a bond.
    pub(crate) fn breaking_speed_m_s(&self) -> Option<f64> {
        let bond = self.bond.as_ref()?;
        let strengths = [bond.tension_n, bond.shear_n].into_iter().filter(|most| *most > 0.0);
        let least_n = strengths.reduce(f64::min)?;
        Some(self.spring_speed_m_s(least_n))
    }

    /// Speed (m/s) that its normal spring, loaded by a force (N), gives the rocks relative to each
    /// other.
    fn spring_speed_m_s(&self, force_n: f64) -> f64 {
        self.law.static_penetration_m(force_n) * self.law.omega_rad_s()
    }

    /// Speed (m/s) of the vibration of rocks with the relative `velocity` (m/s): their normal
    /// speed, or what their spring would give them, whichever is larger.
    pub(crate) fn vibration_speed_m_s(&self, velocity: &Vec3) -> f64 {
        self.spring_speed_m_s(self.normal_force.abs()).max(velocity.dot(&self.n).abs())
    }

    /// Lets a captured contact rebound if it is struck through at a speed of approach (m/s);
    /// returns whether it is. A bond has no rebound.
    pub(crate) fn release_if_struck(&mut self, approach_m_s: f64) -> bool {
        let is_released = self.captured
            && self.bond.is_none()
            && self.law.is_struck_through(self.normal_force, approach_m_s);
        if is_released {
            (self.captured, self.impact) = (false, PairImpact::new(approach_m_s));
        }
        is_released
    }

    /// Breaks the bond: the contact keeps the stretch that friction can hold; the rest is lost.
    pub(crate) fn break_bond(&mut self) {
        (self.bond, self.captured) = (None, true);
        self.normal_force = self.normal_force.max(0.0);
        let (slider, pressed) = (self.law.shear, self.normal_force);
        self.shear = clamp_norm(self.shear, slider.longest_stretch(pressed));
        self.shear_force = slider.capped(self.shear_force, pressed);
    }

    /// Opens the contact.
    pub fn separate(&mut self) {
        self.closed = false;
        self.reset_springs();
    }

    /// Resets its springs to rest.
    pub(crate) fn reset_springs(&mut self) {
        self.impact = PairImpact::default();
        (self.normal_force, self.shear_force, self.shear) = (0.0, Vec3::zeros(), Vec3::zeros());
    }

    /// Energy of its springs (J) for rocks whose centres, in contact from `reach_m` (m) on, are
    /// `distance_m` (m) apart. A bond also stores energy in tension.
    pub fn stored_j(&self, distance_m: f64, reach_m: f64) -> f64 {
        let penetration_m = match &self.bond {
            Some(bond) => bond.length_m - distance_m,
            None => (reach_m - distance_m).max(0.0),
        };
        self.law.stored_j(penetration_m, self.shear.norm_squared(), 0.0)
    }

    /// Whether the pair must be kept. A bonded pair is kept even when its rocks are slightly apart:
    /// a stretched bond pulls.
    pub fn is_held(&self) -> bool {
        self.closed || self.bond.is_some()
    }
}

/// Groups of `count` rocks that are connected by closed contacts or bonds.
pub fn held_groups(count: usize, pair_histories: &[PairHistory]) -> Groups {
    let held = pair_histories.iter().filter(|pair_history| pair_history.is_held());
    Groups::of_pairs(count, held.map(|pair_history| (pair_history.a, pair_history.b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The gap closes linearly in a head-on flight; an off-centre approach makes contact at the
    /// chord.
    #[test]
    fn flying_spheres_meet_when_their_distance_is_the_sum_of_radii() {
        let u = Vec3::new(-2.0, 0.0, 0.0);
        assert_eq!(collision_time_s(&Vec3::new(3.0, 0.0, 0.0), &u, 1.0), Some(1.0));
        let t = collision_time_s(&Vec3::new(3.0, 0.6, 0.0), &u, 1.0).unwrap();
        // |(3 − 2t, 0.6)| = 1 at 3 − 2t = 0.8
        assert!((t - 1.1).abs() < 1e-15);
        assert_eq!(collision_time_s(&Vec3::new(3.0, 1.1, 0.0), &u, 1.0), None);
        assert_eq!(collision_time_s(&Vec3::new(-3.0, 0.0, 0.0), &u, 1.0), None);
        assert_eq!(collision_time_s(&Vec3::new(1.0, 0.0, 0.0), &u, 1.0), Some(0.0));
    }

    /// Tension breaks at `σ_t A`, shear without normal force at `c A`, under pressure at `c A + F
    /// tan φ`.
    #[test]
    fn a_bond_holds_up_to_its_strength() {
        let bond = Bond::new(&BondStrength { tensile_pa: 1e6, cohesion_pa: 2e6 }, 0.5, 1.0);
        let mut law = Law::NONE;
        law.set_friction(0.5);
        let overload = |pull_n: f64, shear_n: f64| bond.overload(&law, pull_n, shear_n);
        let area = 0.25 * PI;
        assert!(overload(-0.999e6 * area, 0.0) <= 0.0);
        assert!((overload(-1.1e6 * area, 0.0) - 0.1).abs() < 1e-12);
        assert!(overload(0.0, 1.999e6 * area) <= 0.0);
        assert!(overload(0.0, 2.001e6 * area) > 0.0);
        assert!(overload(1e6 * area, 2.499e6 * area) <= 0.0);
    }
}
