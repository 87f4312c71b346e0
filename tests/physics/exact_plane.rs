//! One rock on one plane, where the motion is known to the last digit, over every scheme and several triangulations.

use crate::common;
use common::*;
use nalgebra::Rotation3;
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::simulation::{Stop, Trajectory};
use rockfall::solver::Scheme;
use rockfall::terrain::{Terrain, make};

/// The same plane, falling in +y, from unlike triangles.
fn planes(angle_rad: f64) -> Vec<Terrain> {
    let turned = |yaw: f64, facets: Vec<[Vec3; 3]>| -> Vec<[Vec3; 3]> {
        let down = Rotation3::from_axis_angle(&Vec3::x_axis(), -angle_rad);
        let turn = down * Rotation3::from_axis_angle(&Vec3::z_axis(), yaw) * down.inverse();
        facets.into_iter().map(|facet| facet.map(|p| turn * p)).collect()
    };
    let jittered = || make::jittered_plane(16.0, 24, angle_rad);
    let flipped = jittered().into_iter().map(|[a, b, c]| [b, a, c]).collect();
    vec![
        terrain(jittered()),
        terrain(make::jittered_plane(16.0, 1, angle_rad)),
        terrain(turned(0.7, jittered())),
        terrain(flipped),
    ]
}

/// Runs a case on every plane. Steps may end elsewhere on other triangles: where they meet a kink of the motion the
/// results may differ by a part of the row's error, otherwise by rounding.
fn on_planes(
    row: &Row,
    case: &Case,
    angle_rad: f64,
    start: [[f64; 3]; 3],
    longest_s: f64,
) -> Trajectory {
    let mut all: Vec<_> =
        planes(angle_rad).iter().map(|plane| case.run(plane, start, longest_s)).collect();
    let first = all.remove(0);
    for other in &all {
        let apart = (other.end.position_m - first.end.position_m).norm();
        assert!(
            apart <= 0.1 * row.smooth,
            "{}: the triangulation moved the rock by {apart:e} m",
            row.name
        );
    }
    first
}

/// Depth at which the weight rests on the springs of a plane (m).
fn sunk(case: &Case, angle_rad: f64) -> f64 {
    let weight = case.rock.mass_kg() * G * angle_rad.cos();
    weight / case.ground.normal_stiffness_n_m
}

/// A start on a plane through the origin, pressed in as the weight presses it.
fn lying(case: &Case, row: &Row, angle_rad: f64) -> [f64; 3] {
    let height = case.rock.radius_m - if row.springs { sunk(case, angle_rad) } else { 0.0 };
    [0.0, height * angle_rad.sin(), height * angle_rad.cos()]
}

/// The ground of the exact cases with springs of `p_N` (N/m).
fn stiff(p_n: f64) -> Ground {
    Ground { normal_stiffness_n_m: p_n, shear_stiffness_n_m: 0.25 * p_n, ..GROUND }
}

const STILL: [f64; 3] = [0.0; 3];

/// A1, A2, A3: drop from 1 m with e = 0.5; closed form of spring and dashpot with gravity, two impacts before 1 s.
#[test]
fn a_dropped_rock_bounces_as_the_closed_form_says() {
    for row in ROWS {
        for (stiffness, z, v, second) in [
            (1e9, 0.558_838_697_250_74, 0.205_279_706_281_96, 0.905_526_162_784_89),
            (1e7, 0.527_978_308_894_21, 0.617_571_486_257_25, 0.924_035_656_289),
        ] {
            let case = Case { ground: stiff(stiffness), capture_speed_m_s: Some(0.05), ..row.case };
            let end = on_planes(&row, &case, 0.0, [[0.1, 0.2, 1.5], STILL, STILL], 1.0);
            // Rigid: 0.90350790290525 s, thrown up with 4.4271887242357/4 m/s.
            let t = 1.0 - 0.903_507_902_905_25;
            let u = 4.427_188_724_235_7 / 4.0;
            let rigid = (u * t - 0.5 * G * t * t + 0.5, u - G * t, 0.903_507_902_905_25);
            let (z, v, second) = if row.springs { (z, v, second) } else { rigid };
            let name = |what: &str| format!("drop, p_N = {stiffness:e}: {what}");
            let [_, other] = end.impacts[..] else { panic!("{} impacts", end.impacts.len()) };
            hold(&row, &name("2nd impact (s)"), [other.time_s, second, second], row.impact);
            hold(&row, &name("z(1 s) (m)"), [end.end.position_m.z, z, 0.1], row.impact);
            hold(&row, &name("v(1 s) (m/s)"), [end.end.velocity_m_s.z, v, 10.0], row.impact);
        }
    }
}

/// A5, A24: rolling down 20° from rest. With springs the rock first winds up its shear spring.
#[test]
fn a_rock_rolls_down_without_slip() {
    let angle = 20f64.to_radians();
    for row in ROWS {
        let case = row.case;
        let run = on_planes(&row, &case, angle, [lying(&case, &row, angle), STILL, STILL], 1.0);
        let (y, z) = if row.springs {
            (1.295_885_389_840, 0.060_411_322_892)
        } else {
            let s = 1.197_070_501_639_8;
            (0.5 * angle.sin() + s * angle.cos(), 0.5 * angle.cos() - s * angle.sin())
        };
        hold(&row, "roll 20°: y(1 s) (m)", [run.end.position_m.y, y, y], row.smooth);
        hold(&row, "roll 20°: z(1 s) (m)", [run.end.position_m.z, z, y], row.smooth);
    }
}

/// A6: slipping down 40° with μ = 0.2.
#[test]
fn a_rock_slips_where_friction_does_not_hold_it() {
    let angle = 40f64.to_radians();
    for row in ROWS {
        let ground = Ground { friction_angle_rad: 0.2f64.atan(), ..stiff(1e13) };
        let case = Case { ground, ..row.case };
        let start = lying(&case, &row, angle);
        // The springs take a few µs to build up friction.
        let row = Row { smooth: row.smooth + 1e-5, ..row };
        let run = on_planes(&row, &case, angle, [start, STILL, STILL], 1.0);
        let s = (run.end.position_m - Vec3::from(start)).norm();
        hold(&row, "slip 40°, μ 0.2: s(1 s) (m)", [s, 2.398_935_733_207_4, 2.4], row.smooth);
        let w = -run.end.spin_rad_s.x;
        hold(&row, "slip 40°, μ 0.2: ω(1 s) (rad/s)", [w, 7.507_235_542_566, 7.5], row.smooth);
    }
}

/// A7: pushed with 5 m/s on level ground with μ = 0.2: slides for 0.7289 s, then rolls with 5/7 of its speed.
#[test]
fn a_sliding_rock_ends_up_rolling() {
    for row in ROWS {
        let ground = Ground { friction_angle_rad: 0.2f64.atan(), ..stiff(1e13) };
        let case = Case { ground, ..row.case };
        let run =
            on_planes(&row, &case, 0.0, [lying(&case, &row, 0.0), [5.0, 0.0, 0.0], STILL], 1.0);
        let end = run.end;
        hold(&row, "slide to roll: v (m/s)", [end.velocity_m_s.x, 25.0 / 7.0, 5.0], row.smooth);
        hold(
            &row,
            "slide to roll: x(1 s) (m)",
            [end.position_m.x, 4.092_044_981_257_8, 4.1],
            row.smooth,
        );
        // Friction takes 2/7 of the energy.
        let lost = run.ledger.friction_j / run.released_j;
        hold(&row, "slide to roll: share lost (–)", [lost, 2.0 / 7.0, 1.0], row.smooth);
    }
}

/// A8: rolling friction 0.3 stops 5 m/s after 5.952 m and 2.381 s. Stiff springs, so that what they wind up is small.
#[test]
fn rolling_friction_stops_a_rock() {
    for row in ROWS {
        let ground = Ground { rolling_friction: 0.3, ..stiff(1e13) };
        let case = Case { ground, ..row.case };
        let start = [lying(&case, &row, 0.0), [5.0, 0.0, 0.0], [0.0, 10.0, 0.0]];
        let run = on_planes(&row, &case, 0.0, start, 10.0);
        assert_eq!(run.stop, Stop::AtRest);
        let x = run.end.position_m.x;
        hold(&row, "rolling friction: way (m)", [x, 5.952_380_952_381, 6.0], row.smooth);
    }
}

/// A9: on a slope less steep than the rolling friction a rock stays for good.
#[test]
fn a_rock_stays_where_rolling_friction_holds_it() {
    let angle = 20f64.to_radians();
    for row in ROWS {
        let ground = Ground { rolling_friction: 25f64.to_radians().tan(), ..GROUND };
        let case = Case { ground, rest_time_s: 1000.0, ..row.case };
        let start = lying(&case, &row, angle);
        let run = on_planes(&row, &case, angle, [start, STILL, STILL], 100.0);
        assert_eq!(run.stop, Stop::TimeUp);
        // No more than the springs wind up: 2/7 of the weight along the slope on the shear spring, the moment of all
        // of it on the rolling spring.
        let along = case.rock.mass_kg() * G * angle.sin();
        let (p_s, r) = (case.ground.shear_stiffness_n_m, case.rock.radius_m);
        let wound = along / p_s + along * r / (0.1 * p_s * r * r) * r;
        let moved = (run.end.position_m - Vec3::from(start)).norm();
        assert!(moved <= if row.springs { 1.001 * wound } else { 1e-9 }, "{moved}");
        assert!(run.end.velocity_m_s.norm() < 1e-12);
    }
}

/// A16, A18 and a spinning drop: an oblique impact that slips all the time takes `μ (1 + e) v_n` along the surface.
/// A17: one that sticks ends rolling (rigid; a shear spring gives a little back).
#[test]
fn an_oblique_impact_takes_what_friction_allows() {
    for row in ROWS {
        for (name, v, w, v_out, w_out, sticks) in [
            (
                "oblique",
                [5.0, 1.0, -5.0],
                [3.0, -20.0, 4.0],
                [0.728_789_019_113_75, 0.288_131_503_185_63, 2.5],
                [-0.559_342_484_071_87, 1.356_054_904_431_2, 4.0],
                false,
            ),
            (
                "oblique, sticks",
                [5.0, 1.0, -5.0],
                STILL,
                [3.571_428_571_428_6, 0.714_285_714_285_71, 2.5],
                [-1.428_571_428_571_4, 7.142_857_142_857_1, 0.0],
                true,
            ),
            (
                "flat",
                [5.0, 1.0, -1.0],
                STILL,
                [4.150_792_224_391_6, 0.830_158_444_878_31, 0.5],
                [-0.849_207_775_608_45, 4.246_038_877_804_2, 0.0],
                false,
            ),
            (
                "spinning drop",
                [0.0, 0.0, -2.0],
                [0.0, 50.0, 0.0],
                [3f64.sqrt(), 0.0, 1.0],
                [0.0, 50.0 - 5.0 * 3f64.sqrt(), 0.0],
                false,
            ),
        ] {
            // Where friction stops the slip, springs give some of it back: `rigid` is the limit of those (below).
            if sticks {
                continue;
            }
            // Out again after a tenth of a millisecond, a third of which is spent in contact: there the weight does
            // up to 3e-4 m/s of its work on springs that the rigid answer does not know.
            let case = Case { ground: stiff(1e13), capture_speed_m_s: Some(0.01), ..row.case };
            let allowed = row.impact + if row.springs { 1e-4 } else { 0.0 };
            let run = on_planes(&row, &case, 0.0, [[0.0, 0.0, 0.5], v, w], 1e-4);
            for k in 0..3 {
                let g = if k == 2 { G * 1e-4 } else { 0.0 };
                let what = format!("{name}: v_{} (m/s)", ["x", "y", "z"][k]);
                let v = run.end.velocity_m_s[k] + g;
                hold(&row, &what, [v, v_out[k], 5.0], allowed);
                let what = format!("{name}: ω_{} (rad/s)", ["x", "y", "z"][k]);
                hold(&row, &what, [run.end.spin_rad_s[k], w_out[k], 10.0], allowed);
            }
        }
    }
}

/// A19: the oblique impact of A16 on springs of 10⁹ N/m, 0.2 s after a start 0.1 m above the plane.
#[test]
fn an_oblique_impact_on_springs() {
    for row in ROWS.into_iter().filter(|row| row.springs) {
        let case = Case { capture_speed_m_s: Some(0.01), ..row.case };
        let run = on_planes(
            &row,
            &case,
            0.0,
            [[0.0, 0.0, 0.6], [5.0, 1.0, -5.0], [3.0, -20.0, 4.0]],
            0.2,
        );
        for (k, exact) in [0.202_693_999, 0.067_115_667, 0.804_023_327].into_iter().enumerate() {
            let what = format!("oblique on springs: {} (m)", ["x", "y", "z"][k]);
            hold(&row, &what, [run.end.position_m[k], exact, 1.0], row.impact);
        }
        let w = run.end.spin_rad_s.y;
        hold(&row, "oblique on springs: ω_y (rad/s)", [w, 2.259_206_5, 10.0], row.impact);
    }
}

/// A ball that skids, rolls and is stopped by rolling friction rests a time of the rule after it has become slow, with every
/// scheme: on a plane steps may go on for half a second and more, and rest was seen at their ends.
#[test]
fn rest_comes_when_it_is_due() {
    let (mu, rolling_friction, speed_m_s) = (GROUND.friction_angle_rad.tan(), 0.2, 1.0);
    let skids_s = speed_m_s / (G * (mu + 2.5 * (mu - rolling_friction)));
    let rolls_s = (speed_m_s - mu * G * skids_s - 0.02) / (5.0 / 7.0 * rolling_friction * G);
    for row in ROWS {
        for rest_time_s in [0.3, 1.0] {
            let ground = Ground { rolling_friction, ..stiff(1e11) };
            let case = Case { ground, rest_time_s, ..row.case };
            let start = [lying(&case, &row, 0.0), [speed_m_s, 0.0, 0.0], STILL];
            let run = case.run(&planes(0.0)[1], start, 10.0);
            let late_s = run.end.time_s - (skids_s + rolls_s + rest_time_s);
            assert_eq!(run.stop, Stop::AtRest, "{}", row.name);
            assert!(late_s.abs() < 0.02, "{}, {rest_time_s} s: {late_s} s late", row.name);
        }
    }
}

/// `rigid` is the limit of stiff springs of the same law: its rebound is that of `reference` at 1e13 N/m to 1e-4 of the impact
/// speed, sticking and slipping, with and without rolling friction.
#[test]
fn rigid_is_the_limit_of_stiff_springs() {
    let plane = &planes(0.0)[0];
    let speed = |v: &rockfall::rock::Vec3, w: &rockfall::rock::Vec3| (*v, *w * 0.5);
    for rolling_friction in [0.0, 0.3] {
        for (v, w) in [
            ([5.0, 1.0, -5.0], STILL),
            ([5.0, 1.0, -5.0], [3.0, -20.0, 4.0]),
            ([1.0, 0.0, -10.0], [0.0, 0.0, 30.0]),
            ([20.0, 0.0, -1.0], [0.0, 40.0, 0.0]),
            ([-3.0, 2.0, -8.0], [10.0, 25.0, -5.0]),
        ] {
            let after = |scheme, stiffness, tolerance_m_s| {
                let ground = Ground { rolling_friction, ..stiff(stiffness) };
                let case =
                    Case { scheme, ground, tolerance_m_s, capture_speed_m_s: Some(0.0), ..CASE };
                let run = case.run(plane, [[0.0, 0.0, 0.5], v, w], 1e-4);
                speed(&run.end.velocity_m_s, &run.end.spin_rad_s)
            };
            let (v1, w1) = after(Scheme::Rigid, 1e9, 0.05);
            let (v2, w2) = after(Scheme::Reference, 1e13, 1e-8);
            let size = rockfall::rock::Vec3::from(v).norm();
            let off = (v1 - v2).norm().max((w1 - w2).norm()) / size;
            assert!(off < 1e-4, "rolling {rolling_friction}, {v:?} {w:?}: {off:e}");
        }
    }
}
