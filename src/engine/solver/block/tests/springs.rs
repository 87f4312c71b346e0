//! The exact cases with springs: `adaptive`, `reference` and `dda` converge to the rigid limit as
//! their springs get stiff.

use super::cases::{balls, elastic_box, run_backwards};
use super::*;
use crate::solver::Scheme;
use nalgebra::Unit;

/// The scheme with the least error of its own.
pub(super) const FINEST: Scheme = Scheme::Reference;
pub(super) const SCHEMES: [Scheme; 3] = [Scheme::Adaptive, Scheme::Reference, Scheme::Dda];

/// The same run with springs of `p_n` (N/m); `dda` with `ω Δt` = 0.01.
pub(super) fn on_springs(mut case: BlockRun, scheme: Scheme, p_n: f64) -> BlockRun {
    case.ground.normal_stiffness_n_m = p_n;
    case.ground.shear_stiffness_n_m = 0.25 * p_n;
    case.law = law_of(&case.ground, &case.block, case.law.capture_m_s);
    case.springs = Some(Settings {
        scheme,
        tolerance_m_s: 1e-3,
        step_s: 0.01 / case.law.omega_rad_s(),
        shear_memory: true,
        impact_kernels: true,
        rigid_heaps: true,
        corner_way: CORNER_WAY,
        capture_speed_m_s: Some(case.law.capture_m_s),
    });
    case
}

pub(super) fn every_scheme() -> [Scheme; 4] {
    Scheme::ALL
}

/// Length of a fixed step over `√(p_N/m)` where a case lasts long (rad).
const LONG_PHASE: f64 = 0.1;

/// The same run with longer fixed steps.
pub(super) fn with_long_steps(mut case: BlockRun) -> BlockRun {
    let omega = case.law.omega_rad_s();
    if let Some(settings) = &mut case.springs {
        settings.step_s = LONG_PHASE / omega;
    }
    case
}

fn cube(angle: f64, law: (f64, f64)) -> BlockRun {
    BlockRun::new(slope(angle, 100.0), block(&box_surface([1.0; 3]), 0.05), law)
}

/// A cube at rest on 20° presses into its springs by their share of its weight, and stays there.
#[test]
fn a_cube_rests_on_its_springs() {
    let angle = 20_f64.to_radians();
    for scheme in SCHEMES {
        let mut case = on_springs(cube(angle, (1.0, 0.4)), scheme, 1e8);
        let (along, up) = axes(angle);
        let mut state = case.start(tilted(angle), still(up * 0.5));
        let start = state.pose.centre;
        let longest_s = if scheme == Scheme::Dda { 2.0 } else { 100.0 };
        case.follow(&mut state, longest_s, |_, _| ());
        let way = state.pose.centre - start;
        let weight = case.block.mass_kg * G;
        // four springs along the normal and four along the surface, which also let the cube lean:
        // its centre is 0.5 m up
        let (pressed, sheared) = (weight * cos(angle) / 4e8, weight * sin(angle) / 1e8);
        let lean = weight * sin(angle) * 0.25 / (4e8 * 0.45 * 0.45);
        assert!((way.dot(&up) / -pressed - 1.0).abs() < 1e-3, "{scheme:?} {way}");
        assert!((way.dot(&along) / (sheared + lean) - 1.0).abs() < 0.02, "{scheme:?} {way}");
        assert!(state.v.norm() < 1e-8, "{scheme:?} {}", state.v);
    }
}

/// A cube slides on its face with a = g (sin 40° − 0.5 cos 40°) and does not turn; it has sunk into
/// its springs before.
#[test]
fn a_cube_slides_on_its_springs() {
    let angle = 40_f64.to_radians();
    let a = G * (sin(angle) - 0.5 * cos(angle));
    for scheme in SCHEMES {
        let mut case = on_springs(cube(angle, (0.5, 0.4)), scheme, 1e9);
        let (along, up) = axes(angle);
        let mut state = case.start(tilted(angle), still(up * 0.5));
        let mut early = None;
        case.follow(&mut state, 1.5, |t, state| {
            if early.is_none() && t > 0.5 {
                early = Some((t, state.v.dot(&along)));
            }
        });
        let (t, v) = early.unwrap();
        let found = (state.v.dot(&along) - v) / (1.5 - t);
        assert!((found / a - 1.0).abs() < 1e-6, "{scheme:?} {found} {a}");
        let spin = state.spin(&case.block).norm();
        assert!(spin < 1e-6, "{scheme:?} {spin}");
    }
}

/// Motion of a bar that has struck with its lower corners, at `friction` and e = 0.5: velocity and
/// spin.
fn rebounded(case: &mut BlockRun) -> (Vec3, Vec3) {
    let attitude = tilted(30_f64.to_radians());
    let low = attitude * Vec3::new(0.98, 0.08, -0.08);
    let start = [Vec3::z() * (0.02 - low.z + 1e-9), Vec3::new(0.5, 0.2, -3.0), Vec3::zeros()];
    let mut state = case.start(attitude, start);
    let own = case.block.clone();
    let mut out = None;
    case.follow(&mut state, 5e-3, |_, state| {
        if out.is_none() && state.spin(&own).norm() > 1.0 {
            out = Some(());
        }
    });
    (state.v + Vec3::z() * (G * 5e-3), state.spin(&own))
}

/// Case S6: the tilted bar rebounds from its corners as in the rigid impact, to 1e-4 at 1e12 N/m,
/// and the more exactly the stiffer.
#[test]
fn a_tilted_bar_is_thrown_as_in_the_rigid_limit() {
    let bar =
        || BlockRun::new(slope(0.0, 50.0), block(&box_surface([2.0, 0.2, 0.2]), 0.02), (0.0, 0.5));
    let (v, w) = rebounded(&mut bar());
    for (scheme, most) in [(Scheme::Adaptive, 1e-3), (Scheme::Reference, 1e-4), (Scheme::Dda, 2e-2)]
    {
        let off = [1e9, 1e12].map(|p_n| {
            let (own_v, own_w) = rebounded(&mut on_springs(bar(), scheme, p_n));
            ((own_v - v).norm() / v.norm()).max((own_w - w).norm() / w.norm())
        });
        println!("{scheme:?} {off:?}");
        assert!(off[1] < most, "{scheme:?} {off:?}");
    }
}

/// One ball at the centre is a sphere: oblique impacts with friction leave it as the sphere's own
/// scheme does.
#[test]
fn one_ball_bounces_as_a_sphere_does() {
    let (r, mass) = (0.5, 2700.0 * 4.0 / 3.0 * std::f64::consts::PI * 0.125);
    let body = || balls(vec![Vec3::zeros()], r, (mass, [0.4 * mass * r * r; 3]));
    let run = |scheme| on_springs(BlockRun::new(slope(0.0, 50.0), body(), (0.4, 0.6)), scheme, 1e9);
    let start = [Vec3::z() * (r + 1e-9), Vec3::new(4.0, 1.0, -5.0), Vec3::new(1.0, -2.0, 3.0)];
    for (scheme, most) in [(Scheme::Adaptive, 2e-3), (Scheme::Reference, 1e-6), (Scheme::Dda, 2e-2)]
    {
        let mut case = run(scheme);
        let mut state = case.start(Rotation3::identity(), start);
        case.follow(&mut state, 0.05, |_, _| ());
        // the sphere
        let laws = [case.law];
        let own = Body { mass, inertia: 0.4 * mass * r * r, radius: r, gravity: Vec3::z() * -G };
        let world = ContactEnvironment { terrain: &case.terrain, body: own, laws: &laws };
        let mut sphere = crate::solver::contact_state::ContactState::default();
        let centre = Vec3::z() * (r * (1.0 - 1e-12)) - case.terrain.origin_m;
        sphere.begin(&world, centre, start[1], start[2]);
        let settings = Settings { scheme: Scheme::Reference, ..case.springs.unwrap() };
        let mut stepper = crate::solver::Stepper::new(&settings, &world, &mut sphere);
        let mut gone = 0.0;
        loop {
            let left = 0.05 - gone;
            gone += crate::solver::advance(&mut stepper, &world, &mut sphere, left).unwrap().dt;
            if sphere.is_free() {
                break;
            }
        }
        let v = sphere.v - Vec3::z() * (G * (0.05 - gone));
        let off = (state.v - v).norm() / v.norm();
        let turned = (state.spin(&case.block) - sphere.w).norm() / sphere.w.norm();
        println!("{scheme:?} {off:e} {turned:e}");
        assert!(off.max(turned) < most, "{scheme:?} {off:e} {turned:e}");
    }
}

/// A capsule rolls across 20° on both of its balls with g sin 20°/(1 + 7/15), straight on.
#[test]
fn a_capsule_rolls_on_springs() {
    let angle = 20_f64.to_radians();
    let (r, mass) = (0.3, 1000.0);
    let own = 7.0 / 15.0 * mass * r * r;
    let ends = vec![Vec3::y() * 0.4, Vec3::y() * -0.4];
    let a = G * sin(angle) / (1.0 + 7.0 / 15.0);
    for scheme in SCHEMES {
        let body = balls(ends.clone(), r, (mass, [2.0 * own, own, 2.0 * own]));
        let mut case =
            on_springs(BlockRun::new(slope(angle, 100.0), body, (1.0, 0.0)), scheme, 1e9);
        let (along, up) = axes(angle);
        let mut state = case.start(tilted(angle), still(up * r - along * 40.0));
        case.follow(&mut state, 2.0, |_, _| ());
        let speed = state.v.dot(&along) / (2.0 * a);
        assert!((speed - 1.0).abs() < 1e-3, "{scheme:?} {speed}");
        let spin = state.spin(&case.block);
        assert!(spin.x.abs() + spin.z.abs() < 1e-6 && state.v.y.abs() < 1e-6, "{scheme:?} {spin}");
    }
}

/// Elastic bounces backwards on springs of the finest scheme, whose local error is 1e-9 of an
/// impact.
#[test]
fn elastic_bounces_on_springs_run_backwards() {
    run_backwards(on_springs(elastic_box(), Scheme::Reference, 1e9), &[2, 5], 1e-7);
}

/// A mesh of blunt folds: a grid of `cells` a side of 0.3 m with heights up to `most_m`.
fn folds(cells: i32, most_m: f64) -> Terrain {
    let at = |i: i32, j: i32| {
        // neither periodic nor random
        let height = sin(f64::from(i * i) * 0.37 + f64::from(j) * 1.7);
        Vec3::new(0.3 * f64::from(i - cells / 2), 0.3 * f64::from(j - cells / 2), most_m * height)
    };
    let cell = |(i, j): (i32, i32)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    terrain((0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))).flat_map(cell).collect())
}

/// e = 1 without friction on folds that the block is larger than: nothing gains energy, whatever
/// touches, and the finer scheme keeps it.
#[test]
fn elastic_blocks_keep_their_energy_over_folds() {
    for (scheme, most) in [(Scheme::Adaptive, 0.05), (Scheme::Reference, 1e-5), (Scheme::Dda, 1.0)]
    {
        for sides in [[1.0; 3], [1.4, 0.9, 0.35]] {
            let body = block(&box_surface(sides), 0.08);
            let case = BlockRun::new(folds(80, 0.03), body, (0.0, 1.0));
            let mut case = on_springs(case, scheme, 1e9);
            let start = [Vec3::z() * 1.5, Vec3::new(0.4, 0.3, 0.0), Vec3::new(0.5, -1.0, 0.8)];
            let mut state = case.start(Rotation3::identity(), start);
            let before = case.energy_j(&state);
            let own = case.block.clone();
            let energy =
                |state: &BlockState| state.motion_j(&own) + own.mass_kg * G * state.pose.centre.z;
            let mut highest = before;
            case.follow(&mut state, 5.0, |_, state| highest = highest.max(energy(state)));
            let lost = 1.0 - case.energy_j(&state) / before;
            println!(
                "{scheme:?} {sides:?}: lost {lost:e}, rose {:e}, {} steps",
                highest / before - 1.0,
                case.steps
            );
            // the finest scheme is as exact up as down: 1e-9 an impact
            assert!(highest <= before * (1.0 + 1e-8), "{scheme:?} {highest} {before}");
            assert!(lost < most, "{scheme:?} {lost:e}");
        }
    }
}

/// Motion of a block after its first episode of contact: velocity without the effect of weight
/// since its start, and spin.
fn after_first_contact(case: &mut BlockRun, attitude: Rotation3<f64>) -> (Vec3, Vec3) {
    let start = [Vec3::z() * 2.0, Vec3::new(2.0, 1.0, -6.0), Vec3::new(1.0, -2.0, 1.5)];
    let mut state = case.start(attitude, start);
    let own = case.block.clone();
    // steps are short, flights are not
    let (mut flights, mut last) = (0, (0.0, state.clone()));
    case.follow(&mut state, 0.4, |t, state| {
        flights += usize::from(t - last.0 > 2e-3);
        if flights < 2 {
            last = (t, state.clone());
        }
    });
    (last.1.v + Vec3::z() * (G * last.0), last.1.spin(&own))
}

/// Explicitly integrated impacts agree with the implicit stages, the more closely the finer those
/// are: corners and edges on a plane and on folds, with friction, each with another attitude,
/// against the finest scheme.
#[test]
fn explicit_impacts_are_the_implicit_ones() {
    let surfaces = [box_surface([1.4, 0.9, 0.35]), prism_surface(6, 0.7)];
    let mut off = [[0.0; 3]; 24];
    for (k, off) in off.iter_mut().enumerate() {
        let axis = Unit::new_normalize(Vec3::new(1.0, 0.3 * k as f64, 0.7));
        let attitude = turn(&axis, 0.4 + 0.9 * k as f64);
        let ground = || if k % 4 < 2 { slope(0.3, 50.0) } else { folds(80, 0.03) };
        let law = (0.3 + 0.02 * k as f64, 0.2 + 0.03 * k as f64);
        let end = |scheme, tolerance_m_s, explicit| {
            let body = block(&surfaces[k % 2], 0.08);
            let mut case = on_springs(BlockRun::new(ground(), body, law), scheme, 1e10);
            let settings = case.springs.unwrap();
            case.springs = Some(Settings { tolerance_m_s, impact_kernels: explicit, ..settings });
            let (v, w) = after_first_contact(&mut case, attitude);
            (v, w * case.block.bound_m, case.steps)
        };
        let (v, w, _) = end(Scheme::Reference, 1e-8, true);
        let runs = [(0.05, true), (0.05, false), (1e-4, false)];
        for (own, (tolerance_m_s, explicit)) in off.iter_mut().zip(runs) {
            let (own_v, own_w, steps) = end(Scheme::Adaptive, tolerance_m_s, explicit);
            *own = ((own_v - v).norm() + (own_w - w).norm()) / v.norm();
            println!("{k} {tolerance_m_s} {explicit}: {own:e} in {steps} steps");
        }
    }
    for (run, most) in [0, 1, 2].into_iter().zip([3e-3, 5e-3, 5e-4]) {
        let worst = off.iter().map(|off| off[run]).fold(0.0, f64::max);
        assert!(worst < most, "{run}: {worst:e}");
    }
    let [explicit, implicit] = [0, 1].map(|run| off.iter().map(|off| off[run]).sum::<f64>());
    assert!(2.0 * explicit < implicit, "{explicit} {implicit}");
}

/// A contact that a step of `dda` runs into begins with the stretch of its history or, as printed
/// in the paper, with none.
#[test]
fn what_a_step_runs_into_is_without_memory_as_printed() {
    let case = on_springs(cube(0.0, (0.5, 0.4)), Scheme::Dda, 1e9);
    let (own, laws) = (case.block.clone(), [case.law]);
    let world =
        ContactEnvironment { terrain: &case.terrain, body: Body::of_block(&own, G), laws: &laws };
    let end = case.start(Rotation3::identity(), still(Vec3::z() * 0.499));
    for remembers in [true, false] {
        let mut contact_state = BlockContactState::default();
        contact_state.begin_springs(&world, &case.springs.unwrap(), (&own, &end));
        assert_eq!(contact_state.springs.histories.len(), 4);
        contact_state.springs.histories.iter_mut().for_each(|history| history.shear.x = 1e-3);
        contact_state.touches.found.clear();
        let stretch = |contact_state: &BlockContactState, k: usize| {
            if remembers { contact_state.springs.histories[k].shear } else { Vec3::zeros() }
        };
        contact_state.add_new_contacts(&world, (&own, &end, &end), 1e-5, &stretch);
        let known: Vec<f64> = contact_state.springs.stretches_m().collect();
        let expected = if remembers { 1e-3 } else { 0.0 };
        assert!(
            known.len() == 4 && known.iter().all(|x| (x - expected).abs() < 1e-12),
            "{known:?}"
        );
    }
}
