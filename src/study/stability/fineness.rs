//! Steps and tolerances to their ends, and what the printed scheme does without memory.

use super::bounds::{DIGITS, SpringImpact};
use super::impacts::{floor, rebound_m_s};
use super::{Notes, SchemeSetting};
use crate::ground::Ground;
use crate::math;
use crate::rock::Vec3;
use crate::simulation::{Scratch, Stop};
use crate::solver::dda::own_restitution;
use crate::study::bench::{GRAVITY_M_S2, GROUND, SETUP, Setup, settings, terrain};
use crate::terrain::make;
use std::f64::consts::PI;

/// Speed of the impacts (m/s): at the longest step still less than a tenth of the radius a step.
const SPEED_M_S: f64 = 1.0;

/// An impact at every step from 1e-7 to 1e-2 s (tolerance from 1e-7 to 1e-2 m/s): the fixed step leaves by itself what its
/// formula says, whatever the step; the others keep the closed form, the rigid map its own, to the last digits whatever the
/// tolerance.
pub(super) fn steps(way: &SchemeSetting, notes: &mut Notes) {
    let floor = floor();
    let omega = SETUP.omega();
    for power in -7..=-2 {
        let way = &SchemeSetting { fineness: 10f64.powi(power), ..*way };
        let unit = way.scheme.fineness_unit();
        let setting = format!("{:e} {unit}", way.fineness);
        let is_fixed = way.scheme.has_fixed_step();
        // no dashpot: what is lost, the step itself loses
        let restitution = (!is_fixed).then_some(0.5);
        let setup = Setup {
            ground: Ground { restitution, ..GROUND },
            centre_m: Vec3::new(0.3, 0.2, SETUP.rock.radius_m),
            velocity_m_s: Vec3::new(0.0, 0.0, -SPEED_M_S),
            gravity_m_s2: if is_fixed { 0.0 } else { GRAVITY_M_S2 },
            longest_s: 4.0 / omega + if is_fixed { 4.0 * way.fineness } else { 0.0 },
            ..SETUP
        };
        let journey = notes.follow_captured(way, &setting, &setup, &floor, Some(0.02));
        let rebound = rebound_m_s(&journey, &setup) / SPEED_M_S;
        let closed_form = SpringImpact::of(&setup, SPEED_M_S, 0.5).closed_form() / SPEED_M_S;
        let resolved = "rebound over speed is that of the closed form";
        let own = own_restitution(way.fineness * omega);
        // every step rounds
        let rounded = f64::EPSILON * PI / (way.fineness * omega);
        let (law, exact, bound) = way.scheme.of([
            ("rebound over speed is what the step leaves", own, DIGITS + rounded),
            (resolved, closed_form, DIGITS),
            (resolved, closed_form, DIGITS),
            ("rebound over speed is e", 0.5, DIGITS),
        ]);
        notes.hold(way, &setting, law, (rebound - exact).abs(), bound);
    }
}

/// The fixed step as printed forgets its shear stretch: a rock that rolls down 20° slips at `T/(p_s Δt)`, `T = 2/7 m g sin
/// 20°`, the faster the shorter the step. With memory it does not slip.
pub(super) fn memory(way: &SchemeSetting, notes: &mut Notes) {
    if !way.scheme.has_fixed_step() {
        return;
    }
    let angle = 20f64.to_radians();
    let slope = terrain(make::jittered_plane(8.0, 8, angle));
    let height = SETUP.rock.radius_m - SETUP.pressed_m(angle);
    let ground = Ground { restitution: None, ..GROUND };
    let centre_m = Vec3::new(0.1, height * math::sin(angle), height * math::cos(angle));
    let setup = Setup { ground, centre_m, longest_s: 0.5, ..SETUP };
    let pull_n = 2.0 / 7.0 * SETUP.rock.mass_kg() * GRAVITY_M_S2 * math::sin(angle);
    for step_s in [1e-3, 1e-4] {
        for shear_memory in [false, true] {
            let mut step = settings(way.scheme, step_s, None);
            step.shear_memory = shear_memory;
            let journey = setup.follow(&slope, &step, &mut Scratch::default());
            let end = journey.end;
            let along = math::hypot(end.velocity_m_s.y, end.velocity_m_s.z);
            let slip = along - SETUP.rock.radius_m * end.spin_rad_s.x.abs();
            let creep =
                if shear_memory { 0.0 } else { pull_n / (GROUND.shear_stiffness_n_m * step_s) };
            let setting = format!(
                "{step_s:e} s, {}",
                if shear_memory { "with memory" } else { "as printed" }
            );
            let failed = matches!(journey.stop, Stop::Failed(_));
            notes.hold(way, &setting, "fails (0 = no)", f64::from(u8::from(failed)), 0.0);
            let law = "slip off T/(p_s Δt), without memory, or 0 (m/s)";
            notes.hold(way, &setting, law, (slip - creep).abs(), 0.01 * creep + 1e-6);
            let rise = journey.ledger.rise_j / journey.extremes.total_j;
            notes.hold(way, &setting, "energy rise over energy", rise, DIGITS);
        }
    }
}
