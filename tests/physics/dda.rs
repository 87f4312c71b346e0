//! Scheme `dda`: what the paper's fixed step keeps, loses and gets wrong, against closed forms.

use crate::common;

use common::episode::Episode;
use common::{CASE, Case, G, GROUND, ROCK, terrain};
use rockfall::ground::{Ground, damping_ratio, restitution};
use rockfall::rock::{Rock, Vec3};
use rockfall::simulation::Stop;
use rockfall::solver::Scheme;
use rockfall::solver::dda::own_restitution;
use rockfall::terrain::{Terrain, make};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI, SQRT_2};

/// No dashpots: what the step itself dissipates.
const BARE: Ground = Ground { restitution: None, ..GROUND };
const DDA: Case = Case { scheme: Scheme::Dda, ground: BARE, ..CASE };

/// `√(p_N/m)` of rock and ground of the exact cases (rad/s).
fn omega() -> f64 {
    (GROUND.normal_stiffness_n_m / ROCK.mass_kg()).sqrt()
}

fn level() -> Terrain {
    terrain(make::jittered_plane(4.0, 8, 0.0))
}

/// Rebound over approach speed of an undamped impact without gravity that begins `share` of a step before the touch.
fn rebound(terrain: &Terrain, phase: f64, share: f64) -> f64 {
    // slow enough that no step is cut for its length
    let v = 0.01;
    let step_s = phase / omega();
    let case = Case { step_s, ..DDA };
    let start = [[0.1, 0.2, 0.5 + share * v * step_s], [0.0, 0.0, -v], [0.0; 3]];
    Episode::new(terrain, &case, 0.0).run(start, 10_000, |_, _| {}).v.z / v
}

/// The leap ends at the touch: the rebound is the closed form, whatever the step.
#[test]
fn an_impact_keeps_what_the_step_leaves() {
    let level = level();
    for phase in [0.01, 0.1, 0.3, 0.5, 1.0, 1.7, 2.5, 4.0, 10.0, 100.0] {
        let e = rebound(&level, phase, 0.0);
        // penetrations are 1e-6 m, differences of coordinates of 1 m: ten digits are left
        assert!((e - own_restitution(phase)).abs() < 1e-9, "{phase}: {e}");
    }
}

/// Begun anywhere within a step, the mean is `(1+q)^(−π/(2θ))`: 0.992176885814, 0.92456334372686, 0.68376435533484,
/// 0.49730133704229 at ω Δt = 0.01, 0.1, 0.5, 1, and exactly 1/3 for every start at 2.
#[test]
fn impacts_within_a_step_keep_the_known_mean() {
    const STARTS: usize = 200;
    let level = level();
    let known = [
        (0.01, 0.992_176_885_814),
        (0.1, 0.924_563_343_726_86),
        (0.5, 0.683_764_355_334_84),
        (1.0, 0.497_301_337_042_29),
    ];
    for (phase, mean) in known {
        let of = |k: usize| rebound(&level, phase, k as f64 / STARTS as f64);
        let found = (0..STARTS).map(of).sum::<f64>() / STARTS as f64;
        // the closed form counts whole turns; what a part of a step adds averages out to second order
        assert!((found - mean).abs() < 0.005 * phase * phase, "{phase}: {found}");
    }
    for share in [0.0, 0.3, 0.7, 0.99] {
        assert!((rebound(&level, 2.0, share) - 1.0 / 3.0).abs() < 1e-9);
    }
}

/// Beyond ω Δt = 4 an impact within a step may keep anything, but never more than one that begins at the touch.
#[test]
fn no_step_is_so_long_that_an_impact_gains() {
    let level = level();
    for phase in [4.0, 7.0, 10.0, 30.0, 100.0] {
        let most = own_restitution(phase);
        assert!(most < 1.0);
        for k in 0..50 {
            let e = rebound(&level, phase, f64::from(k) / 50.0);
            assert!(e > 0.0 && e < most + 1e-9, "{phase}: {e}");
        }
    }
}

/// Dropped from 1 m with steps over five decades, with and without dashpots: the rock never gets back to where it
/// came from.
#[test]
fn a_dropped_rock_never_comes_back_higher() {
    let level = level();
    for step_s in [1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2] {
        for ground in [BARE, GROUND] {
            let case = Case { step_s, ground, ..DDA };
            // three impacts, or one at the shortest step
            let longest_s = if step_s < 1e-6 { 0.46 } else { 1.5 };
            let fall = case.run(&level, [[0.1, 0.2, 1.5], [0.0; 3], [0.0; 3]], longest_s);
            assert!(fall.end.position_m.z.is_finite() && fall.impact_count > 0);
            assert!(fall.impacts.iter().all(|hit| hit.speed_out_m_s < hit.speed_in_m_s));
            // springs lose k (Δx)²/2 a step: the remainder is a loss, and no impact ends with more than it began with
            assert!(fall.ledger.remainder_j > 0.0, "{step_s}: {:?}", fall.ledger);
            assert!(fall.ledger.rise_j < 1e-9 * fall.released_j, "{step_s}: {:?}", fall.ledger);
        }
    }
}

/// The dashpot and the step's own damping, ζ and ω Δt/4, add up as long as the step resolves the impact.
#[test]
fn dashpots_and_the_step_damp_together() {
    let level = level();
    for e in [0.3, 0.5, 0.8] {
        for phase in [0.003, 0.01, 0.03] {
            let ground = Ground { restitution: Some(e), ..GROUND };
            let case = Case { ground, step_s: phase / omega(), ..DDA };
            let start = [[0.1, 0.2, 0.5], [0.0, 0.0, -1.0], [0.0; 3]];
            let found = Episode::new(&level, &case, 0.0).run(start, 10_000, |_, _| {}).v.z;
            let both = restitution(damping_ratio(e) + 0.25 * phase);
            // the contact ends up to one step late, with the force at its zero: second order
            assert!((found - both).abs() < phase * phase, "{e}, {phase}: {found} {both}");
        }
    }
}

/// Without a restitution there are no dashpots and no capture: the ledger knows nothing but the numerics, and the
/// slowest impact still rebounds. With one, dashpots take `1 − e²` of the energy and slow impacts stay.
#[test]
fn dashpots_come_with_restitution() {
    let level = level();
    let drop = |ground: Ground, height_m: f64| {
        let case = Case { ground, step_s: 1e-6, ..DDA };
        let time_s = (2.0 * height_m / G).sqrt() + 0.006;
        case.run(&level, [[0.1, 0.2, 0.5 + height_m], [0.0; 3], [0.0; 3]], time_s)
    };
    let (bare, damped) = (drop(BARE, 1.0), drop(GROUND, 1.0));
    // rounding of 1e4 J
    assert!(bare.ledger.damping_j.abs() < 1e-9);
    // 3/4 but for gravity on the way through the contact and what the step takes, a thousandth each
    assert!(damped.ledger.damping_j > 0.745 * damped.released_j);
    // 1 cm/s: half the speed below which nothing rebounds from a ground with dashpots
    let (bare, damped) = (drop(BARE, 5e-6), drop(GROUND, 5e-6));
    assert!(bare.end.velocity_m_s.z > 0.0, "{:?}", bare.end);
    assert!(damped.end.velocity_m_s.z.abs() < 1e-3, "{:?}", damped.end);
}

/// Rolling down 20°: without memory the printed shear spring is a dashpot of strength `p_s Δt`, and the rock slips at
/// `T/(p_s Δt)`, `T = 2/7 m g sin 20°`: the shorter the step, the faster.
#[test]
fn without_memory_the_contact_creeps() {
    let slope = terrain(make::jittered_plane(8.0, 8, 20f64.to_radians()));
    for (radius_m, step_s) in [(0.1, 1e-3), (0.1, 1e-4), (0.1, 1e-5), (0.5, 1e-3), (0.5, 1e-4)] {
        let rock = Rock { radius_m, ..ROCK };
        let pull_n = 2.0 / 7.0 * rock.mass_kg() * G * 20f64.to_radians().sin();
        let creep = pull_n / (GROUND.shear_stiffness_n_m * step_s);
        let found = slip_after_1_s(&slope, &Case { rock, step_s, shear_memory: false, ..DDA });
        // the normal force has not come to rest: a thousandth
        assert!((found / creep - 1.0).abs() < 2e-3, "{radius_m}, {step_s}: {found} {creep}");
        let ground = GROUND;
        let held = slip_after_1_s(&slope, &Case { step_s, ground, rock, ..DDA });
        assert!(held.abs() < 1e-9, "{radius_m}, {step_s}: {held}");
    }
}

fn slip_after_1_s(slope: &Terrain, case: &Case) -> f64 {
    let (s, c) = 20f64.to_radians().sin_cos();
    let r = case.rock.radius_m;
    let fall = case.run(slope, [[0.1, s * r, c * r], [0.0; 3], [0.0; 3]], 1.0);
    fall.end.velocity_m_s.dot(&Vec3::new(0.0, c, -s)) - r * fall.end.spin_rad_s.norm()
}

/// With memory: `a = 5/7 g sin 20°`, 1.1970705016398 m in the first second.
#[test]
fn a_rock_rolls_down_at_five_sevenths() {
    let slope = terrain(make::jittered_plane(8.0, 8, 20f64.to_radians()));
    let (s, c) = 20f64.to_radians().sin_cos();
    for step_s in [1e-5, 1e-4, 1e-3, 1e-2] {
        for ground in [BARE, GROUND] {
            let case = Case { step_s, ground, ..DDA };
            let fall = case.run(&slope, [[0.1, s * 0.5, c * 0.5], [0.0; 3], [0.0; 3]], 1.0);
            let way = (fall.end.position_m - fall.start.position_m).norm();
            // it sinks in by m g/p_N and stretches its shear spring by T/p_s, 1.4e-5 m and 5e-6 m
            assert!((way - 1.197_070_501_639_8).abs() < 2e-5, "{step_s}: {way}");
        }
    }
}

/// Rolling friction above the slope holds a rock for good; the springs' stretch is all that it moves.
#[test]
fn rolling_friction_holds_without_creep() {
    let slope = terrain(make::jittered_plane(8.0, 8, 20f64.to_radians()));
    let (s, c) = 20f64.to_radians().sin_cos();
    let ground = Ground { rolling_friction: 0.4, ..GROUND };
    for step_s in [1e-4, 1e-3] {
        let case = Case { step_s, ground, rest_time_s: 99.0, ..DDA };
        let after = |time_s: f64| {
            case.run(&slope, [[0.1, s * 0.5, c * 0.5], [0.0; 3], [0.0; 3]], time_s).end
        };
        let (early, late) = (after(0.5), after(5.0));
        // rounding of the place, some 1e4 steps
        assert!((late.position_m - early.position_m).norm() < 1e-11);
        assert!(late.velocity_m_s.norm() < 1e-9);
        // it turns by `m g sin 20° R/k_r`, 3.8e-4 rad, and stretches its shear spring by 1.9e-5 m; some slip comes
        // before, while the normal force builds up
        let moved = (late.position_m - Vec3::new(0.1, s * 0.5, c * 0.5)).norm();
        assert!(moved < 3e-4, "{moved}");
    }
}

/// A sphere over an edge, from 0.1 rad at rest, without slip: `θ'' = 5/7 g/R sin θ`. Normals are those of the step's
/// start, so the error falls with the step: by four when the step does.
#[test]
fn a_pivot_over_an_edge_is_first_order() {
    let roof = terrain(make::ridge(4.0, FRAC_PI_4));
    let exact = pivot(0.6);
    let error = |step_s: f64| {
        let case = Case { step_s, ground: GROUND, ..DDA };
        let (s, c) = 0.1f64.sin_cos();
        let fall = case.run(&roof, [[0.5 * s, 0.0, 0.5 * c], [0.0; 3], [0.0; 3]], 0.6);
        let (s, c) = exact.sin_cos();
        (fall.end.position_m - Vec3::new(0.5 * s, 0.0, 0.5 * c)).norm()
    };
    let errors = [8e-3, 2e-3, 5e-4].map(error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log(4.0);
        // the springs' give, 1.4e-5 m, is a fiftieth of the smallest error
        assert!((order - 1.0).abs() < 0.15, "{errors:?}");
    }
}

/// Angle of the rolling pivot after `time_s` (rad), by Runge–Kutta of fourth order.
fn pivot(time_s: f64) -> f64 {
    const N: u32 = 10_000;
    let h = time_s / f64::from(N);
    let pull = |angle: f64| 5.0 / 7.0 * G / 0.5 * angle.sin();
    let (mut angle, mut rate) = (0.1f64, 0.0);
    for _ in 0..N {
        let k1 = (rate, pull(angle));
        let k2 = (rate + 0.5 * h * k1.1, pull(angle + 0.5 * h * k1.0));
        let k3 = (rate + 0.5 * h * k2.1, pull(angle + 0.5 * h * k2.0));
        let k4 = (rate + h * k3.1, pull(angle + h * k3.0));
        angle += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
        rate += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
    }
    angle
}

/// Oblique impact with spin against the exact compliant motion after 0.2 s; first order.
#[test]
fn an_oblique_impact_converges_to_the_compliant_law() {
    let level = level();
    let error = |step_s: f64| {
        let case = Case { step_s, ground: GROUND, ..DDA };
        let start = [[-3.0, 0.0, 0.6], [5.0, 1.0, -5.0], [3.0, -20.0, 4.0]];
        let end = case.run(&level, start, 0.2).end;
        let exact = Vec3::new(-3.0 + 0.202_693_999, 0.067_115_667, 0.804_023_327);
        (end.position_m - exact).norm()
    };
    let errors = [1e-4, 1e-5, 1e-6].map(error);
    assert!(errors[2] < 3e-4, "{errors:?}");
    for pair in errors.windows(2) {
        assert!(((pair[0] / pair[1]).log10() - 1.0).abs() < 0.05, "{errors:?}");
    }
}

/// A 90° groove: exactly two contacts. Without friction each carries `m g/√2` and is pressed in by
/// 9.7965568786392e-6 m; with friction the shear springs carry their part and the rock sinks by `m g/(p_N + p_s)`.
#[test]
fn a_groove_holds_with_two_contacts() {
    let groove = terrain(make::v_groove(4.0, FRAC_PI_4));
    let weight = ROCK.mass_kg() * G;
    let sinks = [
        (0.0, 9.796_556_878_639_2e-6 * SQRT_2),
        (GROUND.friction_angle_rad, weight / (1.25 * GROUND.normal_stiffness_n_m)),
    ];
    for (friction_angle_rad, sunk) in sinks {
        let case = Case { step_s: 1e-4, ground: Ground { friction_angle_rad, ..GROUND }, ..DDA };
        let start = [[0.0, 0.3, 0.5 * SQRT_2], [0.0; 3], [0.0; 3]];
        let end = Episode::new(&groove, &case, G).run(start, 10_000, |_, _| {});
        let place = end.c + groove.origin_m;
        assert_eq!(end.histories.len(), 2);
        // coordinates of 1 m, springs of 1e9 N/m: 1e-15 m are 1e-6 N
        assert!((place.z - (0.5 * SQRT_2 - sunk)).abs() < 1e-12, "{}", place.z);
        let share = FRAC_1_SQRT_2 * sunk * GROUND.normal_stiffness_n_m;
        assert!(
            end.histories.iter().all(|hold| (hold.normal_force - share).abs() < 1e-3),
            "{share}"
        );
    }
}

/// As printed, friction is that of the step before: on the way out of an impact it is too strong, turns the slip
/// round, and neither sliding nor sticking fits. Such steps are counted; with memory, and the cap of the present
/// force, there is none.
#[test]
fn steps_that_do_not_settle_are_counted() {
    let slope = terrain(make::jittered_plane(8.0, 8, 0.0));
    let unsettled = |shear_memory: bool| {
        let case = Case { step_s: 1e-3, shear_memory, ..DDA };
        let of = |k: u32| {
            let start = [[0.0, 0.2, 0.6], [0.1 * f64::from(k), 0.0, -2.0], [0.0; 3]];
            case.run(&slope, start, 0.5).effort.unsettled
        };
        (0..10).map(of).sum::<u64>()
    };
    assert!(unsettled(false) > 0);
    assert_eq!(unsettled(true), 0);
}

/// Without friction nothing turns a rock, to the last bit.
#[test]
fn without_friction_spin_stays() {
    let slope = terrain(make::jittered_plane(8.0, 8, 20f64.to_radians()));
    let ground = Ground { friction_angle_rad: 0.0, ..GROUND };
    let spin = [3.0, -20.0, 4.1];
    let case = Case { step_s: 1e-4, ground, ..DDA };
    let fall = case.run(&slope, [[0.1, 0.0, 0.7], [1.0, 0.0, -3.0], spin], 1.0);
    assert!(fall.impact_count > 0);
    assert_eq!(fall.end.spin_rad_s, Vec3::from(spin));
}

/// Springs so soft that the rock sinks in by half its radius: it counts as failed, with the reason.
#[test]
fn a_rock_that_sinks_in_fails() {
    let ground = Ground { normal_stiffness_n_m: 1e5, shear_stiffness_n_m: 2.5e4, ..BARE };
    let case = Case { ground, step_s: 1e-4, ..DDA };
    let fall = case.run(&level(), [[0.1, 0.2, 1.5], [0.0; 3], [0.0; 3]], 9.0);
    assert!(matches!(&fall.stop, Stop::Failed(why) if why.contains("sank in")), "{:?}", fall.stop);
}

/// Half a period of the free step: `ρ^N` shrinks as `exp(−π ω Δt/4)`, numerical damping of ratio ω Δt/4.
#[test]
fn own_restitution_is_that_of_a_damping_ratio() {
    for phase in [1e-3, 1e-2, 0.1] {
        let damped = (-0.25 * PI * phase).exp();
        // the way out takes up to a step less than the half period: phase²/8
        assert!((own_restitution(phase) - damped).abs() < 0.15 * phase * phase);
    }
    assert!((own_restitution(2.0) - 1.0 / 3.0).abs() < 1e-15);
}
