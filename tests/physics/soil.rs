//! Soft soil under a sphere: scar layer, restitution that falls with speed, friction that grows with slip. Every scheme.
#![allow(clippy::print_stdout, reason = "a test prints its table")]

use crate::common;

use common::{CASE, Case, G, ROWS, Row, hold, terrain, terrain_of_files};
use rockfall::ground::{Ground, Scar, SlipFriction, cut_area_m2, swept_m3};
use rockfall::rock::Vec3;
use rockfall::simulation::{Scratch, Trajectory};
use rockfall::solver::Scheme;
use rockfall::study::bench::{BlockForm, MadeBlock, SETUP, Setup, settings};
use rockfall::terrain::Terrain;

/// Lu et al. (2019): a meadow.
const MEADOW: Scar = Scar { strength_kn_m2: 15e3, drag: 2.5, soil_density_kg_m3: 1700.0 };

/// All rows, and the paper's fixed step, whose own dissipation decides (π/4 of its phase of 0.0084 rad). Springs have gravity in an impact, and some
/// millimetres of way in the soil, which the closed forms leave out.
fn rows() -> Vec<Row> {
    let case = Case { scheme: Scheme::Dda, step_s: 1e-6, ..CASE };
    let dda = Row { name: "dda 1e-6", case, impact: 8e-3, ..ROWS[0] };
    let wider =
        |row: Row| Row { impact: row.impact.max(if row.springs { 1e-3 } else { 0.0 }), ..row };
    ROWS.into_iter().chain([dda]).map(wider).collect()
}

/// A plane through the origin that falls along x by an angle (rad).
fn plane(angle: f64) -> Terrain {
    let at = |x: f64, y: f64| Vec3::new(x * angle.cos(), y, -x * angle.sin());
    terrain(vec![[at(-400.0, -400.0), at(400.0, -400.0), at(0.0, 800.0)]])
}

/// A row on a ground without friction, with restitution `e` and a scar.
fn slick(row: &Row, e: f64, scar: Option<Scar>) -> Case {
    let p = if row.springs { 1e11 } else { 1e9 };
    let ground = Ground {
        normal_stiffness_n_m: p,
        shear_stiffness_n_m: 0.25 * p,
        friction_angle_rad: 0.0,
        restitution: Some(e),
        scar,
        ..row.case.ground
    };
    Case { ground, capture_speed_m_s: Some(0.02), ..row.case }
}

/// Speed that the rock had when it left the plane z = 0, without the height it has gained since.
fn speed_off(case: &Case, run: &Trajectory) -> f64 {
    let (end, height) = (&run.end, run.end.position_m.z - case.rock.radius_m);
    (end.velocity_m_s.norm_squared() + 2.0 * G * height).sqrt()
}

/// In and out of the soil by the closed form of drag alone, between them an impact with e = 0.5: falling square, and at an angle.
/// What the soil took stands in the ledger and in the row of the impact.
#[test]
fn a_rock_is_slowed_on_its_way_into_the_soil_and_out_of_it() {
    let flat = plane(0.0);
    for row in rows() {
        for v in [[0.0, 0.0, -10.0], [8.0, 0.0, -6.0], [15.0, -5.0, -4.0]] {
            let case = slick(&row, 0.5, Some(MEADOW));
            let (r, m) = (case.rock.radius_m, case.rock.mass_kg());
            let depth = MEADOW.depth_m(m, -v[2]);
            let keeps = |v: &Vec3| {
                let swept = swept_m3(r, depth, v.z.abs() / v.norm());
                (-MEADOW.drag_per_m3(m) * swept).exp()
            };
            let start = Vec3::from(v);
            let within = start * keeps(&start);
            let thrown = Vec3::new(within.x, within.y, -0.5 * within.z);
            let out = thrown * keeps(&thrown);
            let run = case.run(&flat, [[0.0, 0.0, r], v, [0.0; 3]], 0.01);
            hold(
                &row,
                "speed out of the soil",
                [speed_off(&case, &run), out.norm(), 10.0],
                row.impact,
            );
            let along = run.end.velocity_m_s.x;
            hold(&row, "speed along the soil", [along, out.x, 10.0], row.impact);
            let energy = |v: &Vec3| 0.5 * m * v.norm_squared();
            let soil = energy(&start) - energy(&within) + energy(&thrown) - energy(&out);
            let scale = energy(&start);
            hold(&row, "soil_j", [run.ledger.soil_j, soil, scale], 2.0 * row.impact);
            let [impact] = &run.impacts[..] else { panic!("{}: {:?}", row.name, run.impacts) };
            assert!((impact.soil_j - run.ledger.soil_j).abs() <= 1e-9 * scale, "{impact:?}");
            let lost = energy(&start) - energy(&out);
            hold(&row, "energy_lost_j", [impact.energy_lost_j, lost, scale], 2.0 * row.impact);
        }
    }
}

/// Soil without drag is no soil: the same motion to the last bit, with friction, rolling friction and roughness.
#[test]
fn a_scar_without_drag_changes_no_bit() {
    let slope = plane(0.6);
    for row in rows().into_iter().filter(|row| !row.name.starts_with("dda")) {
        let rough = Ground { rolling_friction: 0.1, roughness_rad: 0.1, ..row.case.ground };
        let run = |scar| {
            let case = Case { ground: Ground { scar, ..rough }, ..row.case };
            case.run(&slope, [[0.0, 0.0, 2.0], [5.0, 1.0, 0.0], [0.0; 3]], 4.0)
        };
        let hard = run(None);
        assert!(hard.impact_count > 1);
        for none in [Scar { drag: 0.0, ..MEADOW }, Scar { soil_density_kg_m3: 0.0, ..MEADOW }] {
            assert_eq!(run(Some(none)), hard, "{}", row.name);
        }
    }
}

/// What does not rebound ploughs on: |v|' = −k A |v|² with the segment that is cut at the depth of the scar, so that the way is
/// ln(1 + k A v₁ t)/(k A).
#[test]
fn a_rock_that_stays_in_its_scar_ploughs() {
    let flat = plane(0.0);
    for row in rows() {
        let case = slick(&row, 0.0, Some(MEADOW));
        let (r, m) = (case.rock.radius_m, case.rock.mass_kg());
        let depth = MEADOW.depth_m(m, 5.0);
        let k = MEADOW.drag_per_m3(m);
        let begins = 10.0 * (-k * swept_m3(r, depth, 0.2_f64.sqrt())).exp();
        let ka = k * cut_area_m2(r, depth, 0.0);
        let time = if row.name.starts_with("dda") { 0.2 } else { 3.0 };
        let run = case.run(&flat, [[0.0, 0.0, r], [10.0, 0.0, -5.0], [0.0; 3]], time);
        let way = (1.0 + ka * begins * time).ln() / ka;
        // springs let it hop
        let allowed = if row.springs { 5e-3 } else { 1e-3 };
        hold(&row, "way ploughed", [run.end.position_m.x, way, way], allowed);
        let speed = begins / (1.0 + ka * begins * time);
        hold(&row, "speed ploughing", [run.end.velocity_m_s.x, speed, speed], allowed);
    }
}

/// Soil that ends at a cliff, along a smooth wall without soil that the rock is pushed against: the wall is no floor of the scar. Over the
/// cliff it leaves its scar and digs a new one 1 m below, as without the wall.
#[test]
fn a_wall_beside_a_scar_is_not_its_floor() {
    let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let level = |x: [f64; 2], z: f64| {
        let [a, b, c, d] =
            [at(x[0], -9.0, z), at(x[1], -9.0, z), at(x[1], 9.0, z), at(x[0], 9.0, z)];
        [[a, b, c], [a, c, d]]
    };
    let soil: Vec<_> = [level([-2.0, 2.0], 0.0), level([2.5, 90.0], -1.0)].concat();
    let wall = vec![[at(-200.0, 0.0, -99.0), at(200.0, 0.0, -99.0), at(0.0, 0.0, 99.0)]];
    let open = terrain(soil.clone());
    let mut walled = terrain_of_files(vec![soil, wall], Some(1e-9));
    walled.sheets[1].ground = 1;
    for row in ROWS {
        let case = slick(&row, 0.0, Some(MEADOW));
        let case = Case { other: Some(Ground { scar: None, ..case.ground }), ..case };
        let r = case.rock.radius_m;
        let soil_j = |terrain: &Terrain, aside: f64| {
            let start = [[0.0, -1.0001 * r, r], [10.0, aside, -5.0], [0.0; 3]];
            case.run(terrain, start, 1.0).ledger.soil_j
        };
        let (free, beside) = (soil_j(&open, 0.0), soil_j(&walled, 0.2));
        println!("{}: {free} {beside}", row.name);
        assert!((beside / free - 1.0).abs() < 0.02, "{}: {free} {beside}", row.name);
    }
}

/// A rock that ploughs comes from soil to hard ground, which takes nothing, and to soil of twice the drag, which takes twice as much on each
/// metre. The scar went on over any ground until the rock lifted off.
#[test]
fn a_scar_ends_with_its_soil() {
    let half = |x: [f64; 2]| {
        let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
        let [a, b, c, d] = [at(x[0], -9.0), at(x[1], -9.0), at(x[1], 9.0), at(x[0], 9.0)];
        vec![[a, b, c], [a, c, d]]
    };
    let mut ends = terrain_of_files(vec![half([-9.0, 1.0]), half([1.0, 99.0])], Some(1e-9));
    ends.sheets[1].ground = 1;
    let stronger = Scar { drag: 2.0 * MEADOW.drag, ..MEADOW };
    for (row, beyond, times) in
        ROWS.into_iter().flat_map(|row| [(row, None, 0.0), (row, Some(stronger), 2.0)])
    {
        let case = slick(&row, 0.0, Some(MEADOW));
        let case = Case { other: Some(Ground { scar: beyond, ..case.ground }), ..case };
        let (r, m) = (case.rock.radius_m, case.rock.mass_kg());
        let depth = MEADOW.depth_m(m, 5.0);
        let k = MEADOW.drag_per_m3(m);
        let begins = 10.0 * (-k * swept_m3(r, depth, 0.2_f64.sqrt())).exp();
        let ka = k * cut_area_m2(r, depth, 0.0);
        let run = case.run(&ends, [[0.0, 0.0, r], [10.0, 0.0, -5.0], [0.0; 3]], 1.0);
        let beyond_m = times * (run.end.position_m.x - 1.0);
        let speed = begins * (-ka * (1.0 + beyond_m)).exp();
        hold(&row, "speed beyond the soil", [run.end.velocity_m_s.x, speed, speed], 6e-3);
    }
}

/// Whether a rock hardly rebounds or not at all makes no jump: it stays in its scar either way.
#[test]
fn hardly_any_rebound_is_like_none() {
    let flat = plane(0.0);
    for row in ROWS {
        let speed = |e: f64| {
            let case = slick(&row, e, Some(MEADOW));
            let start = [[0.0, 0.0, case.rock.radius_m], [10.0, 0.0, -5.0], [0.0; 3]];
            case.run(&flat, start, 2.0).end.velocity_m_s.x
        };
        let none = speed(0.0);
        for e in [0.01, 0.03, 0.06, 0.1] {
            let some = speed(e);
            println!("{} e {e}: {some} {none}", row.name);
            assert!(
                (some / none - 1.0).abs() < 0.3 * e + 2e-3,
                "{} e {e}: {some} {none}",
                row.name
            );
        }
    }
}

/// On rough soft ground with everything at once: no episode gains energy, the ledger has nothing negative and adds up, and the
/// soil stops what the hard slope does not.
#[test]
fn soil_never_gives_energy() {
    let slope = plane(0.55);
    for row in ROWS {
        for seed in 1..6 {
            let slip = SlipFriction { most: 1.3, kappa_per_m: 0.7, beta_per_s: 20.0 };
            let ground = Ground {
                roughness_rad: 0.2,
                scar: Some(Scar { strength_kn_m2: 5e3, ..MEADOW }),
                slip_friction: Some(slip),
                restitution_half_m_s: Some(9.0),
                ..row.case.ground
            };
            let case = Case { ground, ..row.case };
            let start = [[0.0, 0.0, 6.0], [4.0, 0.3, 0.0], [0.0, 3.0, 0.0]];
            let run = case.run_with(&slope, start, 10.0, seed);
            let ledger = &run.ledger;
            assert!(ledger.soil_j > 0.0 && ledger.friction_j >= 0.0 && ledger.damping_j >= 0.0);
            let gain = ledger.rise_j / run.released_j;
            // rows with springs are exact to their steps
            let allowed = if row.springs { 1e-5 } else { 1e-9 };
            assert!(gain <= allowed, "{} {seed}: {gain:e}", row.name);
            let error = run.energy_balance_error();
            assert!(error < 5e-3, "{} {seed}: {error:e} {ledger:?}", row.name);
        }
    }
}

/// `e(v) = e/(1 + (v/v_half)²)`: half of it is left at `v_half`.
#[test]
fn restitution_falls_with_the_speed_of_the_impact() {
    let flat = plane(0.0);
    for row in rows() {
        for v in [1.0, 9.144, 25.0] {
            let mut case = slick(&row, 0.6, None);
            case.ground.restitution_half_m_s = Some(9.144);
            let e = 0.6 / (1.0 + (v / 9.144_f64).powi(2));
            let start = [[0.0, 0.0, case.rock.radius_m], [3.0, 0.0, -v], [0.0; 3]];
            let run = case.run(&flat, start, 0.01);
            let up = (run.end.velocity_m_s.z.powi(2)
                + 2.0 * G * (run.end.position_m.z - case.rock.radius_m))
                .sqrt();
            hold(&row, "rebound", [up, e * v, v], row.impact);
        }
    }
}

/// The soil takes its share before the rock rebounds: restitution that falls with speed is that of what is left, `e(k v) k v` up, and on its way out the
/// soil takes its share again.
#[test]
fn restitution_in_a_scar_is_that_of_the_speed_left() {
    let flat = plane(0.0);
    let (v, half_m_s) = (10.0, 9.144);
    let scar = Scar { drag: 2.0 * MEADOW.drag, ..MEADOW };
    for row in rows() {
        let mut case = slick(&row, 0.6, Some(scar));
        case.ground.restitution_half_m_s = Some(half_m_s);
        let (r, m) = (case.rock.radius_m, case.rock.mass_kg());
        let kept = (-scar.drag_per_m3(m) * swept_m3(r, scar.depth_m(m, v), 1.0)).exp();
        let within = kept * v;
        let e = 0.6 / (1.0 + (within / half_m_s).powi(2));
        let run = case.run(&flat, [[0.0, 0.0, r], [0.0, 0.0, -v], [0.0; 3]], 0.01);
        let exact = e * within * kept;
        hold(&row, "rebound from the soil", [speed_off(&case, &run), exact, v], row.impact);
    }
}

/// A sphere slides down 45° under friction that grows with slip: u' = g (sin − 7/2 μ(s) cos), s' = u, so that
/// u²/2 = g (s sin − 7/2 cos ∫ μ ds). Slip and its way follow from velocity and place: u = 7/2 v − 5/2 g t sin.
#[test]
fn friction_of_a_sphere_grows_with_slip() {
    let angle = std::f64::consts::FRAC_PI_4;
    let slope = plane(angle);
    let (sine, cosine) = angle.sin_cos();
    let (least, most, kappa) = (0.1, 0.6, 0.5);
    let exact = |s: f64| {
        let grown = s * (kappa * s).atan() - (1.0 + (kappa * s).powi(2)).ln() / (2.0 * kappa);
        let friction = least * s + (most - least) / std::f64::consts::FRAC_PI_2 * grown;
        (2.0 * G * (s * sine - 3.5 * cosine * friction)).sqrt()
    };
    for row in ROWS {
        let slip = SlipFriction { most, kappa_per_m: kappa, beta_per_s: 20.0 };
        let ground = Ground {
            friction_angle_rad: f64::atan(least),
            slip_friction: Some(slip),
            restitution: Some(0.0),
            ..row.case.ground
        };
        let case = Case { ground, ..row.case };
        let r = case.rock.radius_m;
        let start = [[r * sine, 0.0, r * cosine], [0.0; 3], [0.0; 3]];
        for time in [0.6, 0.9] {
            let run = case.run(&slope, start, time);
            let along = Vec3::new(cosine, 0.0, -sine);
            let (x, v) =
                ((run.end.position_m - Vec3::from(start[0])).dot(&along), run.end.velocity_m_s);
            let slipped = 3.5 * x - 1.25 * G * sine * time * time;
            let u = v.dot(&along) - r * run.end.spin_rad_s.y;
            assert!(slipped > 0.3, "{slipped}");
            hold(&row, "slip under growing friction", [u, exact(slipped), exact(slipped)], 5e-3);
        }
    }
}

/// A cube that falls flat on soil is slowed on its way in and out as the ball of its volume is, with every scheme; between them it rebounds
/// from its four corners with the restitution of the ground.
#[test]
fn a_block_is_slowed_as_the_ball_of_its_volume() {
    let (form, speed) = (BlockForm::Box([1.0; 3]), 10.0);
    let block = MadeBlock { form, ball_m: 0.05, attitude: nalgebra::Rotation3::identity() };
    let ground = Ground {
        normal_stiffness_n_m: 1e12,
        shear_stiffness_n_m: 0.25e12,
        friction_angle_rad: 0.0,
        scar: Some(MEADOW),
        ..SETUP.ground
    };
    let setup = Setup {
        rock: form.rock(),
        block: Some(block),
        ground,
        centre_m: Vec3::z() * 0.51,
        velocity_m_s: Vec3::z() * -speed,
        longest_s: 0.02,
        ..SETUP
    };
    let (r, m, g) = (setup.rock.radius_m, setup.rock.mass_kg(), setup.gravity_m_s2);
    let comes = (speed * speed + 2.0 * g * 0.01).sqrt();
    let swept = swept_m3(r, MEADOW.depth_m(m, comes), 1.0);
    let kept = (-MEADOW.drag_per_m3(m) * swept).exp();
    for scheme in Scheme::ALL {
        let fineness = scheme.of([1e-7, 1e-3, 1e-6, 1e-3]);
        let run =
            setup.follow(&plane(0.0), &settings(scheme, fineness, None), &mut Scratch::default());
        let rise = 2.0 * g * (run.end.position_m.z - 0.5);
        let found = (run.end.velocity_m_s.z.powi(2) + rise).sqrt() / comes;
        println!("{scheme:?} {found} {}", 0.5 * kept * kept);
        let most = scheme.of([8e-3, 1e-3, 1e-3, 1e-9]);
        assert!((found / (0.5 * kept * kept) - 1.0).abs() < most, "{scheme:?} {found} {kept}");
        assert!(run.ledger.soil_j > 0.0 && run.end.spin_rad_s.norm() < 1e-6, "{scheme:?}");
    }
}

/// A box that comes down on an edge and skids on it over level ground, under friction that grows with slip, goes as far in the rigid limit, at
/// any step, as with springs.
#[test]
fn friction_of_a_block_grows_with_slip_on_its_edge() {
    let form = BlockForm::Box([1.0, 0.8, 0.6]);
    let attitude = nalgebra::Rotation3::from_euler_angles(0.0, 0.4, 0.0);
    let slip = SlipFriction { most: 0.6, kappa_per_m: 2.0, beta_per_s: 1e-6 };
    let ground = Ground {
        normal_stiffness_n_m: 1e10,
        shear_stiffness_n_m: 2.5e9,
        friction_angle_rad: 10.0_f64.to_radians(),
        slip_friction: Some(slip),
        restitution: Some(0.0),
        ..SETUP.ground
    };
    let setup = Setup {
        rock: form.rock(),
        block: Some(MadeBlock { form, ball_m: 0.08, attitude }),
        ground,
        centre_m: Vec3::z() * 0.46,
        velocity_m_s: Vec3::y() * 6.0,
        longest_s: 2.0,
        ..SETUP
    };
    let way_m = |scheme: Scheme, fineness: f64| {
        let step = settings(scheme, fineness, None);
        let run = setup.follow(&plane(0.0), &step, &mut Scratch::default());
        (run.end.position_m - setup.centre_m).norm()
    };
    let springs = way_m(Scheme::Reference, 1e-6);
    for step_s in [0.01, 0.001] {
        let rigid = way_m(Scheme::Rigid, step_s);
        println!("springs {springs} m, rigid at {step_s} s {rigid} m");
        assert!((rigid / springs - 1.0).abs() < 0.02, "{rigid} for {springs} m");
    }
}
