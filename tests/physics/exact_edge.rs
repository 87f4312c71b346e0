//! One rock on edges, in grooves, against walls and over corners, where the motion is known, over every scheme.

use crate::common;
use common::*;
use nalgebra::Rotation3;
use rockfall::contact::ContactPoints;
use rockfall::contact::neighbours::Neighbours;
use rockfall::flight::{FlightEnd, Parabola, time_of_impact};
use rockfall::ground::Ground;
use rockfall::rock::Vec3;
use rockfall::simulation::{FeatureKind, Stop};
use rockfall::solver::Scheme;
use rockfall::terrain::stl::Facet;
use rockfall::terrain::{Terrain, make};

fn stiff(p_n: f64) -> Ground {
    Ground { normal_stiffness_n_m: p_n, shear_stiffness_n_m: 0.25 * p_n, ..GROUND }
}

/// A sharp edge along y through the origin: the top of a steep roof, and the border of a level plate in x < 0.
fn edges() -> [Terrain; 2] {
    let roof = make::ridge(4.0, 80f64.to_radians());
    let plate = make::jittered_plane(4.0, 1, 0.0);
    let plate = plate.into_iter().map(|facet| facet.map(|p| p - Vec3::x() * 4.0));
    // Far down, so that a rock that has tipped off has not left the terrain.
    let deep = [Vec3::new(6.0, 0.0, -9.0), Vec3::new(7.0, 0.0, -9.0), Vec3::new(6.0, 1.0, -9.0)];
    [terrain(roof), terrain(plate.chain([deep]).collect())]
}

/// A centre at `angle` from the upright over the edge, at distance `lever`.
fn over_edge(lever: f64, angle: f64) -> [f64; 3] {
    [lever * angle.sin(), 0.3, lever * angle.cos()]
}

/// Where a rock that rolls from the top of an edge lifts off (rad), for friction μ: without slip `s = 10/7 (1 − cos θ)`
/// until `2/7 sin θ = μ (cos θ − s)`, then `s' = 2 sin θ − 2 μ (cos θ − s)`, with `s = θ'² R/g`; off where `s = cos θ`.
fn lift_angle(mu: f64) -> f64 {
    let rolling = |th: f64| 10.0 / 7.0 * (1.0 - th.cos());
    let slip = bisect(|th| 2.0 / 7.0 * th.sin() - mu * (th.cos() - rolling(th)), 0.0, 0.95);
    let (a, b) = (-6.0 * mu, 4.0 * mu * mu - 2.0);
    let part = |th: f64| (a * th.sin() + b * th.cos()) / (1.0 + 4.0 * mu * mu);
    let sliding =
        |th: f64| (rolling(slip) - part(slip)) * (2.0 * mu * (th - slip)).exp() + part(th);
    bisect(|th| sliding(th) - th.cos(), slip, 0.95)
}

/// Where a rising function is zero.
fn bisect(f: impl Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (lo + hi);
        if f(middle) < 0.0 { lo = middle } else { hi = middle }
    }
    0.5 * (lo + hi)
}

/// A10, A11, A12: tipping off a sharp edge from the top. Lifts at cos θ = 10/17 without slip, 2/3 without friction; the
/// table in between. The springs (10¹³ N/m) bend it by some 1e-5.
#[test]
fn a_rock_tips_off_a_sharp_edge() {
    let table = [
        (5.0, 0.875_389_128_751_34, 0.413_132_925_317_3),
        (30.0, 0.923_245_251_537_5, 0.688_341_721_401_26),
        (60.0, 0.935_225_851_220_09, 0.739_924_660_767_14),
        (80.0, 0.939_827_833_142_19, 0.758_633_278_701_05),
    ];
    for (phi, theta, _) in table {
        let ours = lift_angle(f64::to_radians(phi).tan());
        assert!((ours - theta).abs() < 1e-11, "the closed form gives {ours} for {theta}");
    }
    // Rolling until friction, which is almost without limit, lets go at the very end.
    let no_slip = (lift_angle(1e4).cos() - 10.0 / 17.0).abs();
    assert!(no_slip < 1e-4, "{no_slip}");
    for row in ROWS {
        for terrain in edges() {
            for (phi, theta, spin) in table {
                let ground = Ground { friction_angle_rad: f64::to_radians(phi), ..stiff(1e13) };
                let case = Case { ground, capture_speed_m_s: Some(0.0), ..row.case };
                // On the way, rolling: v² = 10/7 g R (1 − cos θ).
                let from: f64 = 0.2;
                let r = case.rock.radius_m;
                let v = (10.0 / 7.0 * G * r * (1.0 - from.cos())).sqrt();
                let sunk = if row.springs {
                    case.rock.mass_kg() * (G * from.cos() - v * v / r) / 1e13
                } else {
                    0.0
                };
                let start = over_edge(r - sunk, from);
                let velocity = [v * from.cos(), 0.0, -v * from.sin()];
                let run = case.run(&terrain, [start, velocity, [0.0, v / r, 0.0]], 0.45);
                // v² = g R cos θ where it lifts, and the speed forward stays: v cos θ.
                let cos = (run.end.velocity_m_s.x.powi(2) / (G * r)).cbrt();
                hold(&row, &format!("edge φ {phi}°: cos θ"), [cos, theta.cos(), 1.0], row.edge);
                let w = run.end.spin_rad_s.y * (r / G).sqrt();
                hold(&row, &format!("edge φ {phi}°: ω √(R/g)"), [w, spin, 1.0], row.edge);
            }
        }
    }
}

/// A13, A14, A15: from rest at 0.1 rad with φ = 30°: position after 1 s, in flight since 0.785 s.
#[test]
fn a_rock_tips_off_an_edge_on_springs() {
    for row in ROWS {
        for (p_n, x, z, w) in [
            (1e9, 0.622_017_225_3, -0.223_764_632_5, Some(3.036_709_628_9)),
            (1e7, 0.624_205_207_3, -0.225_483_631_9, None),
        ] {
            // Rigid: lifts at θ with speed v after t.
            let (th, t, v) = (0.926_860_928_088_68_f64, 0.784_278_576_868_45, 1.715_139_101_983_2);
            let left = 1.0 - t;
            let rigid_x = 0.5 * th.sin() + v * th.cos() * left;
            let rigid_z = 0.5 * th.cos() - v * th.sin() * left - 0.5 * G * left * left;
            let (x, z, w) = match (row.springs, w) {
                (true, w) => (x, z, w),
                (false, _) => (rigid_x, rigid_z, Some(3.036_627_549_330_7)),
            };
            let case = Case { ground: stiff(p_n), capture_speed_m_s: Some(0.0), ..row.case };
            let weight = case.rock.mass_kg() * G * 0.1f64.cos();
            let sunk = if row.springs { weight / p_n } else { 0.0 };
            for terrain in edges() {
                let start = over_edge(0.5 - sunk, 0.1);
                let run = case.run(&terrain, [start, [0.0; 3], [0.0; 3]], 1.0);
                let name = |what: &str| format!("edge from rest, p_N {p_n:e}: {what}");
                hold(&row, &name("x(1 s) (m)"), [run.end.position_m.x, x, 1.0], row.edge);
                hold(&row, &name("z(1 s) (m)"), [run.end.position_m.z, z, 1.0], row.edge);
                if let Some(w) = w {
                    hold(&row, &name("ω (rad/s)"), [run.end.spin_rad_s.y, w, 3.0], row.edge);
                }
            }
        }
    }
}

/// A20: leaps onto a face, an edge, a corner and a slope, to the last digits.
#[test]
fn leaps_end_at_the_touch() {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let plate = |x: f64, z: f64| {
        let far = [at(x, -9.0, z), at(x + 9.0, -9.0, z), at(x + 9.0, 9.0, z), at(x, 9.0, z)];
        vec![[far[0], far[1], far[2]], [far[0], far[2], far[3]]]
    };
    let corner = vec![[at(3.0, 0.2, 0.0), at(9.0, -6.0, -9.0), at(9.0, 6.0, -9.0)]];
    let drop = 9.0 * 38f64.to_radians().tan();
    let slope = vec![
        [at(-9.0, -9.0, drop), at(9.0, -9.0, -drop), at(9.0, 9.0, -drop)],
        [at(-9.0, -9.0, drop), at(9.0, 9.0, -drop), at(-9.0, 9.0, drop)],
    ];
    let cases: [(&str, Vec<Facet>, f64); 4] = [
        ("face", plate(-4.0, 0.0), 0.958_314_847_499_91),
        ("edge", plate(3.0, 0.0), 0.959_879_171_341_37),
        ("corner", corner, 0.964_108_147_134_68),
        ("38° slope", slope, 1.212_882_760_520_4),
    ];
    for (name, facets, exact) in cases {
        let terrain = terrain(facets);
        let start = at(0.0, 0.0, 5.0) - terrain.origin_m;
        let flight = Parabola { start, velocity: at(3.0, 0.0, 0.0), gravity: G, radius: 0.5 };
        let FlightEnd::Touch(t) = time_of_impact(&terrain, &flight, 9.0, &mut 0) else {
            panic!("{name}")
        };
        println!("leap to {name}: {t} for {exact}, error {:.1e}", (t - exact).abs());
        assert!((t - exact).abs() < 5e-14, "{name}: {t} for {exact}");
    }
}

/// The contacts of a rock of radius 0.5 m at a map position.
fn touches(terrain: &Terrain, centre: Vec3) -> ContactPoints {
    let (mut near, mut touches) = (Neighbours::default(), ContactPoints::default());
    let centre = centre - terrain.origin_m;
    near.collect(terrain, &centre, 0.5, 0.175, 0.05);
    near.touches(terrain, &centre, 0.5 * (1.0 + 1e-7), &mut touches);
    touches
}

/// A21: a rock comes to rest in a groove of 90° on exactly two faces, each carrying `mg/√2`, wherever it came from.
#[test]
fn a_rock_rests_in_a_groove_on_two_faces() {
    let groove = terrain(make::v_groove(4.0, 45f64.to_radians()));
    for row in ROWS {
        for x in [0.0, 0.2, -1.0] {
            let ground = Ground { rolling_friction: 0.05, ..GROUND };
            let case = Case { ground, ..row.case };
            let run = case.run(&groove, [[x, 0.1, 1.0 + 0.71 + x.abs()], [0.0; 3], [0.0; 3]], 60.0);
            assert_eq!(run.stop, Stop::AtRest, "{} from {x}", row.name);
            let exact = if row.springs { 0.707_092_926_762_95 } else { 0.5f64.sqrt() };
            let end = run.end.position_m;
            // The shear springs hold part of the 1.4e-5 m by which the springs give.
            hold(&row, &format!("groove from {x}: height (m)"), [end.z, exact, 1.0], 1e-5);
            assert!(end.x.abs() < 2e-5, "{end:?}");
            let touches = touches(&groove, end);
            assert_eq!(touches.len(), 2);
            assert!(touches.iter().all(|touch| touch.feature.kind == FeatureKind::Face));
        }
    }
}

/// A22: rolling along a groove of 90° that falls at 20°: `a = g sin 20°/(1 + 4/5)`, the lever to the axis is R/√2.
#[test]
fn a_rock_rolls_along_a_groove() {
    let down = Rotation3::from_axis_angle(&Vec3::x_axis(), -20f64.to_radians());
    let groove = make::v_groove(4.0, 45f64.to_radians());
    let groove = terrain(groove.into_iter().map(|facet| facet.map(|p| down * p)).collect());
    for row in ROWS {
        for p_n in [1e9, 1e11, 1e14] {
            let ground = Ground { friction_angle_rad: 50f64.to_radians(), ..stiff(p_n) };
            let case = Case { ground, ..row.case };
            let start = down * Vec3::new(0.0, -3.0, 0.5f64.sqrt());
            let run = case.run(&groove, [start.into(), [0.0; 3], [0.0; 3]], 1.0);
            let s = (run.end.position_m - start).norm();
            let exact = 0.5 * 1.862_109_669_217_5;
            // Springs of 1e9 N/m give by 2e-6 of the way.
            let allowed = row.smooth + 3e-6 * 1e9 / p_n;
            hold(&row, &format!("groove, p_N {p_n:e}: s(1 s) (m)"), [s, exact, exact], allowed);
            // Stiff springs do not make it dear.
            let steps = run.effort.steps + run.effort.rejected;
            assert!(!row.springs || steps < 120, "{} p_N {p_n:e}: {:?}", row.name, run.effort);
        }
    }
}

/// Rolling into a wall at any phase of the steps: the wall gives back at most what it got, and nobody gets into it.
#[test]
fn a_rock_rolls_into_a_wall() {
    for wall_deg in [30f64, 60.0, 90.0, 120.0] {
        let wall = Rotation3::from_axis_angle(&Vec3::x_axis(), wall_deg.to_radians());
        let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
        let quad = |a: Vec3, b: Vec3, c: Vec3, d: Vec3| [[a, b, c], [a, c, d]];
        let floor = quad(at(-5.0, -9.0), at(5.0, -9.0), at(5.0, 0.0), at(-5.0, 0.0));
        let face = quad(at(-5.0, 0.0), at(5.0, 0.0), wall * at(5.0, 5.0), wall * at(-5.0, 5.0));
        let terrain = terrain(floor.into_iter().chain(face).collect());
        for row in ROWS {
            for phase in 0..40 {
                let y = -3.0 - 0.01 * f64::from(phase);
                let case = Case { rest_time_s: 100.0, ..row.case };
                let start = [[0.3, y, 0.5], [0.0, 5.0, 0.0], [-10.0, 0.0, 0.0]];
                let run = case.run(&terrain, start, 1.5);
                let name = format!("{} wall {wall_deg}° phase {phase}", row.name);
                assert!(!matches!(run.stop, Stop::Failed(_)), "{name} {run:?}");
                let rise = run.ledger.rise_j / run.released_j;
                let share = run.ledger.remainder_j / run.released_j;
                if phase % 10 == 0 {
                    println!("{name}: rise {rise:.1e}, remainder {share:.1e} {:?}", run.effort);
                }
                assert!(rise < 1e-9, "{name}: rises by {rise:e}");
                assert!(share.abs() < 3.0 * row.impact, "{name}: remainder {share:e}");
                let first_j =
                    run.start.translational_j(&run.rock) + run.start.rotational_j(&run.rock);
                // What the weight does while the rock sinks in by 1.4e-5 m and a bit.
                assert!(run.extremes.total_j <= first_j + 1.0, "{name} {first_j} {run:?}");
            }
        }
    }
}

/// Rolling off a border faster than `√(gR)` a rock flies from the border on: `z = R − g t²/2`, at any phase of the steps.
#[test]
fn a_fast_rock_flies_off_a_border() {
    let [_, plate] = edges();
    for row in ROWS {
        let mut worst = 0.0f64;
        for phase in 0..40 {
            let x = -1.5 - 0.0123 * f64::from(phase);
            let sunk = if row.springs { row.case.rock.mass_kg() * G / 1e9 } else { 0.0 };
            let start = [[x, 0.3, 0.5 - sunk], [5.0, 0.0, 0.0], [0.0, 10.0, 0.0]];
            let t = 0.2;
            let run = row.case.run(&plate, start, t - x / 5.0);
            let end = run.end;
            worst = worst.max((end.position_m.z - 0.5 + 0.5 * G * t * t).abs());
            worst = worst.max((end.velocity_m_s.z + G * t).abs() * t);
            worst = worst.max((end.position_m.x - 5.0 * t).abs());
        }
        println!("{} off a border: {worst:e} m", row.name);
        // The springs, pressed in by 1.4e-5 m, throw it up by 6e-5 m.
        assert!(worst < row.edge + 1e-4, "{}: {worst:e} m", row.name);
    }
}

/// A plane of 30° that falls along x to a wall square to it.
fn plane_with_a_wall() -> Terrain {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let at =
        |along: f64, up: f64, y: f64| Vec3::new(along * cos + up * sin, y, up * cos - along * sin);
    let sheet = |[a, b]: [[f64; 2]; 2]| {
        let [p, q] = [a, b].map(|[along, up]| at(along, up, -20.0));
        let [r, s] = [b, a].map(|[along, up]| at(along, up, 20.0));
        [[p, q, r], [p, r, s]]
    };
    terrain([[[-20.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 9.0]]].map(sheet).concat())
}

/// A rock that rolls down a plane strikes the wall at its foot with `v = √(10/7 g s sin θ)`, wherever it started: the wall bears nothing before it is
/// met. With `rigid` it did, in the step before the impact: the rock had lost 0.06 to 0.8 % of its speed when it struck, and a
/// tenth of it from 7.3 m, where the wall was first seen in the middle of that step.
#[test]
fn a_wall_bears_nothing_before_it_is_struck() {
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let slope = plane_with_a_wall();
    let ground = Ground { friction_angle_rad: 60f64.to_radians(), ..GROUND };
    for case in [
        Case { scheme: Scheme::Rigid, step_s: 0.01, ground, ..CASE },
        Case { scheme: Scheme::Adaptive, ground, ..CASE },
        Case { scheme: Scheme::Reference, tolerance_m_s: 1e-8, ground, ..CASE },
    ] {
        for way_m in [0.5, 0.7, 1.0, 1.5, 2.2, 3.3, 5.0, 7.3] {
            let (along, up) = (-(ROCK.radius_m + way_m), ROCK.radius_m);
            let start = [along * cos + up * sin, 0.3, up * cos - along * sin];
            let run = case.run(&slope, [start, [0.0; 3], [0.0; 3]], 5.0);
            let exact = (10.0 / 7.0 * G * way_m * sin).sqrt();
            let struck = run.impacts.iter().find(|impact| impact.speed_in_m_s > 0.5 * exact);
            let Some(struck) = struck else { panic!("{:?} {way_m} m: no wall", case.scheme) };
            let off = struck.speed_in_m_s / exact - 1.0;
            let allowed = if case.scheme == Scheme::Rigid { 1e-5 } else { 3e-4 };
            assert!(off.abs() < allowed, "{:?} {way_m} m: {off:e}", case.scheme);
        }
    }
}

/// A sphere that rolls down into a valley of two planes of 5° and up the other side keeps `((0.4 + cos 10°)/1.4)²` of its energy, however slow it
/// comes: it turns about the new contact at once, and the old one lets go. The step in which it met the other side held it on both,
/// and it lost two to five times as much where it came too slow to rebound.
#[test]
fn a_slow_rock_rolls_through_a_valley() {
    let fold = 5f64.to_radians();
    let (sin, cos) = fold.sin_cos();
    let at = |x: f64, y: f64| Vec3::new(x, y, x.abs() * fold.tan());
    let quad = |[a, b]: [f64; 2]| {
        let [p, q, r, s] = [at(a, -5.0), at(b, -5.0), at(b, 5.0), at(a, 5.0)];
        [[p, q, r], [p, r, s]]
    };
    let valley = terrain([[-5.0, 0.0], [0.0, 5.0]].map(quad).concat());
    let kept = ((0.4 + (2.0 * fold).cos()) / 1.4).powi(2);
    let radius = ROCK.radius_m;
    let ground = Ground { restitution: Some(0.0), ..GROUND };
    let case = Case { scheme: Scheme::Rigid, step_s: 0.01, ground, ..CASE };
    for way_m in [0.05, 0.1, 0.2, 0.35, 0.5, 0.8] {
        // from rest, its contact so far up the slope; the way down ends where it touches both sides
        let along = way_m + radius * fold.tan();
        let start = [-along * cos + radius * sin, 0.3, along * sin + radius * cos];
        let came_j = case.rock.mass_kg() * G * way_m * sin;
        // down and up again, not back to the fold
        let down_s = (2.0 * way_m / (G * sin / 1.4)).sqrt();
        let run = case.run(&valley, [start, [0.0; 3], [0.0; 3]], 1.7 * down_s);
        let ledger = &run.ledger;
        let lost = (ledger.friction_j + ledger.damping_j + ledger.rolling_j) / came_j;
        let off = lost / (1.0 - kept) - 1.0;
        assert!(off.abs() < 0.03, "{way_m} m: {lost} of {}", 1.0 - kept);
    }
}
