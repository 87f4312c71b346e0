//! Drag in a scar, part by part, against its closed forms.

use super::*;
use std::f64::consts::PI;

/// The hard plane lies far below the ball, so that all of it is cut, without gravity:
/// `v = v₀ exp(−C ρ_s A z/2m)` with `A = π R²`, on the way in, square and at an angle, and along
/// the plane, in one step or many.
#[test]
fn a_ball_deep_in_soil_slows_by_the_closed_form_of_drag() {
    let radius = 0.5;
    let mass = 2700.0 * 4.0 / 3.0 * PI * radius * radius * radius;
    let inertia = 0.4 * mass * radius * radius;
    let body = Body { mass, inertia, radius, gravity: Vec3::zeros() };
    let (up, speed) = (Vec3::z(), 10.0);
    for cosine in [1.0, 0.6] {
        let enter = |strength_kn_m2| {
            let scar = Scar { strength_kn_m2, drag: 2.5, soil_density_kg_m3: 1700.0 };
            let layers = vec![Some(scar)];
            let mut scars = Scars { layers, is_any: true, ..Scars::default() };
            let blow = GroundBlow {
                ground: 0,
                normal: up,
                approach_m_s: cosine * speed,
                of_point_m_s: speed,
            };
            let kept = scars.enter(&body, &[blow], (speed, false));
            (scar.depth_m(mass, cosine * speed), kept, scars)
        };
        let (shallow, before, _) = enter(10.0);
        let (deep, after, mut scars) = enter(5.0);
        assert!(shallow > 2.0 * radius && deep > shallow);
        let area = PI * radius * radius;
        let per_m = 2.5 * 1700.0 * area / (2.0 * mass);
        let known = math::exp(-per_m * (deep - shallow) / cosine);
        assert!((after / before / known - 1.0).abs() < 1e-12, "{cosine}");
        let whole = scars.plough(&body, (0.7, ScarFloor::On(0, up)), None);
        assert!((whole / math::exp(-per_m * 0.7) - 1.0).abs() < 1e-12, "{whole}");
        // and shared out over the steps before and after as they come
        let mut ahead = 1.0;
        let parts: f64 =
            (0..7).map(|_| scars.plough(&body, (0.1, ScarFloor::Unknown), None)).product();
        scars.split = DragSplit::default();
        for way_m in [0.1, 0.2, 0.02, 0.08, 0.1, 0.2] {
            ahead *= scars.plough_ahead();
            ahead *= scars.plough(&body, (way_m, ScarFloor::Unknown), None);
        }
        assert!((ahead / whole - 1.0).abs() < 1e-12, "{ahead} {whole}");
        assert!((parts / whole - 1.0).abs() < 1e-12, "{parts} {whole}");
    }
}

/// A hop within the soil loses what drag takes on the flown path, step by step, at the depth that
/// the ball then has; the error by the curvature of the path is small. A hop that rises out is
/// dragged until it is out, and a flight of no duration loses nothing.
#[test]
fn a_hop_in_a_scar_is_dragged_as_deep_as_it_is() {
    let (radius, g) = (0.4, 9.81);
    let mass = 2700.0 * 4.0 / 3.0 * PI * radius * radius * radius;
    let (inertia, gravity) = (0.4 * mass * radius * radius, Vec3::new(0.0, 0.0, -g));
    let body = Body { mass, inertia, radius, gravity };
    let scar = Scar { strength_kn_m2: 8000.0, drag: 2.5, soil_density_kg_m3: 1700.0 };
    let layers = vec![Some(scar)];
    let mut scars = Scars { layers, is_any: true, ..Scars::default() };
    let blow = GroundBlow { ground: 0, normal: Vec3::z(), approach_m_s: 3.0, of_point_m_s: 3.0 };
    scars.enter(&body, &[blow], (14.0, false));
    let (dug, k) = (scars.active, scar.drag_per_m3(mass));
    let depth = scar.depth_m(mass, 3.0);
    for share in [0.02, 0.5, 0.9] {
        let up = share * (2.0 * g * depth).sqrt();
        scars.active = dug;
        let way_out = scars.leave(&body, &Vec3::new(14.0, 0.0, up));
        let (mut at, mut v, dt) = (0.0, Vec3::new(14.0, 0.0, up), 1e-6);
        while at >= 0.0 {
            let cut = cut_area_m2(radius, depth - at, v.z.abs() / v.norm());
            v += (gravity - v * (k * cut * v.norm())) * dt;
            at += v.z * dt;
        }
        let hop_s = 2.0 * way_out * up / g;
        let kept = way_out * scars.fly(&body, &(Vec3::new(14.0, 0.0, -up) * way_out), hop_s);
        assert!(scars.active.is_some() && way_out < 1.0, "{share}");
        let taken = [1.0 - kept, 1.0 - v.norm() / 14.0_f64.hypot(up)];
        println!("{share}: {taken:?} way out {way_out}");
        assert!((taken[0] / taken[1] - 1.0).abs() < 0.1, "{share}: {taken:?}");
    }
    scars.active = dug;
    assert!(scars.fly(&body, &Vec3::new(14.0, 0.0, 0.0), 0.0) >= 1.0 && scars.active.is_some());
    // over ground that falls away: from the plane it is out after d = g t (T − t)/2
    let kept = scars.fly(&body, &Vec3::new(14.0, 0.0, -9.81), 1.0);
    assert!(scars.active.is_none() && kept < 1.0);
    let out_s = 0.5 * (1.0 - (1.0 - 8.0 * depth / g).sqrt());
    let most = k * cut_area_m2(radius, depth, 0.0) * 14.9 * out_s;
    assert!(-math::ln(kept) < 0.5 * most && -math::ln(kept) > 0.25 * most, "{kept}");
}

/// Of two soils that are dug to equal depth the one with less drag counts, whichever is struck
/// first.
#[test]
fn of_two_soils_as_deep_the_weaker_drag_counts() {
    let mass = 1400.0;
    let body = Body { mass, inertia: 0.1 * mass, radius: 0.5, gravity: Vec3::z() * -9.81 };
    let soil = |drag| Some(Scar { strength_kn_m2: 5000.0, drag, soil_density_kg_m3: 1700.0 });
    let blow = |ground: u16, side: f64| {
        let normal = Vec3::new(side, 0.0, 1.0).normalize();
        GroundBlow { ground, normal, approach_m_s: 4.0, of_point_m_s: 4.0 }
    };
    let kept = |layers: Vec<Option<Scar>>, blows: [GroundBlow; 2]| {
        let mut scars = Scars { layers, is_any: true, ..Scars::default() };
        scars.enter(&body, &blows, (10.0, false))
    };
    let both = [soil(1.2), soil(4.0)];
    let one = kept(both.into(), [blow(0, 1.0), blow(1, -1.0)]);
    let swapped = kept(both.into(), [blow(1, -1.0), blow(0, 1.0)]);
    let weak = kept(vec![soil(1.2), None], [blow(0, 1.0), blow(1, -1.0)]);
    assert!((one - swapped).abs() < 1e-15 && (one - weak).abs() < 1e-15, "{one} {swapped} {weak}");
    // hard ground beside soil takes nothing of it
    let beside = kept(vec![None, soil(1.2)], [blow(0, 1.0), blow(1, -1.0)]);
    assert!((beside - weak).abs() < 1e-15 && weak < 0.99, "{beside} {weak}");
}

/// A ball of stone of radius 0.5 m on soil of this strength, where gravity is `g`, and what drags
/// it on each metre when all of it is cut (1/m).
fn deep(strength_kn_m2: f64, g: f64) -> (Body, Scars, f64) {
    let (radius, scar) = (0.5_f64, Scar { strength_kn_m2, drag: 2.5, soil_density_kg_m3: 1700.0 });
    let mass = 2700.0 * 4.0 / 3.0 * PI * radius.powi(3);
    let body = Body { mass, inertia: 0.1 * mass, radius, gravity: Vec3::z() * -g };
    let scars = Scars { layers: vec![Some(scar)], is_any: true, ..Scars::default() };
    (body, scars, 2.5 * 1700.0 * PI * radius * radius / (2.0 * mass))
}

fn square(approach_m_s: f64) -> GroundBlow {
    GroundBlow { ground: 0, normal: Vec3::z(), approach_m_s, of_point_m_s: approach_m_s }
}

/// A faster impact in a scar digs on from the depth of the ball: it pays for the path from the
/// first depth to its own, and a slower one pays nothing.
#[test]
fn a_harder_impact_digs_on_from_the_depth_of_the_first() {
    let (body, mut scars, per_m) = deep(5.0, 0.0);
    scars.enter(&body, &[square(6.0)], (6.0, false));
    let first_m = scars.active.unwrap().depth_m;
    assert!(first_m > 2.0 * body.radius);
    assert!(scars.enter(&body, &[square(4.0)], (4.0, false)) >= 1.0);
    let kept = scars.enter(&body, &[square(9.0)], (9.0, false));
    let more_m = scars.active.unwrap().depth_m - first_m;
    assert!((kept / math::exp(-per_m * more_m) - 1.0).abs() < 1e-12, "{kept} over {more_m} m");
}

/// Perpendicularly out of a depth `d ≥ R` a ball cuts `π R² (d − R/3)`. Half of the step in which
/// contact ends is along the plane, and the prepaid drag of a step that never came is not applied
/// again on the exit.
#[test]
fn the_way_out_takes_what_was_not_taken_along_the_plane() {
    let up = Vec3::z() * 10.0;
    let in_scar = || {
        let (body, mut scars, per_m) = deep(5.0, 0.0);
        scars.enter(&body, &[square(6.0)], (6.0, false));
        let out_m = scars.active.unwrap().depth_m - body.radius / 3.0;
        (body, scars, per_m, out_m)
    };
    let is = |kept: f64, exact: f64| assert!((kept / exact - 1.0).abs() < 1e-12, "{kept} {exact}");
    let (body, mut scars, per_m, out_m) = in_scar();
    let kept = scars.plough(&body, (0.4, ScarFloor::Unknown), Some(up));
    is(kept, math::exp(-per_m * (0.5 * 0.4 + out_m)));
    let (body, mut scars, per_m, out_m) = in_scar();
    scars.plough(&body, (0.4, ScarFloor::Unknown), None);
    let ahead = scars.plough_ahead();
    is(ahead, math::exp(-per_m * 0.2));
    is(ahead * scars.leave(&body, &up), math::exp(-per_m * out_m));
}

/// A ball 1.2 m deep needs 4.9 m/s to rise to the surface after the drag of the exit, seven tenths:
/// at 8 m/s it stays in its scar, at 20 m/s it is out. In the scar it rises, all of it cut, to
/// `h = u²/2g exp(−2 k h)`, and falls back through the same height of soil.
#[test]
fn drag_decides_whether_a_ball_leaves_its_scar() {
    let (body, mut scars, per_m) = deep(20.0, 9.81);
    scars.enter(&body, &[square(6.0)], (6.0, false));
    let depth_m = 1.2;
    let dug = Some(ActiveScar { depth_m, ..scars.active.unwrap() });
    let kept = math::exp(-per_m * (depth_m - body.radius / 3.0));
    for (up_m_s, leaves) in [(8.0_f64, false), (20.0, true)] {
        assert_eq!((kept * up_m_s).powi(2) > 2.0 * 9.81 * depth_m, leaves);
        assert!(up_m_s.powi(2) > 2.0 * 9.81 * depth_m);
        scars.active = dug;
        let found = scars.leave(&body, &(Vec3::z() * up_m_s));
        let rise_m = (found * up_m_s).powi(2) / (2.0 * 9.81);
        assert!(leaves || rise_m < depth_m - body.radius);
        let exact = if leaves { kept } else { math::exp(-per_m * rise_m) };
        assert!((found / exact - 1.0).abs() < 1e-12, "{up_m_s} m/s: {found}");
        assert_eq!(scars.active.is_none(), leaves);
        let back = scars.fly(&body, &(Vec3::z() * -up_m_s * found), 2.0 * up_m_s * found / 9.81);
        let exact = if leaves { 1.0 } else { math::exp(-per_m * rise_m) };
        assert!((back / exact - 1.0).abs() < 1e-12, "{up_m_s} m/s back: {back} {exact}");
    }
}

/// More drag never makes a hop higher or longer, and where it begins to hold the rock in its scar
/// the hop is as high as the rim: perpendicular and at angles, slow and fast. Formerly a rock that
/// could not climb out flew as if there were no soil.
#[test]
fn more_drag_never_makes_a_higher_leap() {
    let (body, soft, _) = deep(3000.0, 9.81);
    let leap = |drag: f64, v: &Vec3, ahead_m: f64| {
        let scar = Scar { drag, ..soft.layers[0].unwrap() };
        let mut scars = Scars { layers: vec![Some(scar)], is_any: true, ..Scars::default() };
        scars.enter(&body, &[square(40.0)], (40.0, false));
        let depth_m = scars.active.unwrap().depth_m;
        scars.split.paid_m = ahead_m;
        let thrown = v * scars.leave(&body, v);
        let (rise_m, hop_s) = (0.5 * thrown.z * thrown.z / 9.81, 2.0 * thrown.z / 9.81);
        let out = scars.active.is_none();
        let back = Vec3::new(thrown.x, 0.0, -thrown.z);
        let kept = scars.fly(&body, &back, hop_s);
        assert!(thrown.x.is_finite() && (0.0..=1.0).contains(&kept), "{drag} {v:?} {kept}");
        (rise_m / depth_m, thrown.x * hop_s, out)
    };
    let mut rims = 0;
    for [x, z] in
        [[0.0, 6.0], [0.0, 30.0], [20.0, 8.0], [20.0, 3.0], [30.0, 0.5], [9.0, 1e-9], [9.0, 1e-200]]
    {
        for ahead_m in [0.0, 0.05] {
            let all: Vec<_> = (0..400)
                .map(|k| leap(0.01 * 1.03_f64.powi(k), &Vec3::new(x, 0.0, z), ahead_m))
                .collect();
            for pair in all.windows(2) {
                let [(high, long, _), (rise, length, out)] = [pair[0], pair[1]];
                assert!(rise <= high * (1.0 + 1e-9), "{x} {z}: {rise} after {high}");
                assert!(length <= long * (1.0 + 1e-9), "{x} {z}: {length} after {long}");
                assert!(out == (rise > 1.0 - 1e-9), "{x} {z}: {rise} of the depth, out {out}");
                // no jump where it no longer climbs out: less than a tenth of the hop for 3 % more
                // drag
                if pair[0].2 != out {
                    rims += 1;
                    assert!(rise > 0.8 && high < 1.2, "{x} {z}: {rise} after {high}");
                }
            }
        }
    }
    assert!(rims >= 6, "{rims}");
}

/// All of the ball is cut on its rise, so that a hop of which soil over a length `p` is prepaid
/// rises to `h = u²/2g exp(−2 k (h − p))`, and freely if that is at most `p`. When it has come down
/// again nothing is prepaid, and the next hop is independent.
#[test]
fn soil_that_is_paid_for_is_paid_once() {
    let (body, mut scars, per_m) = deep(20.0, 9.81);
    scars.enter(&body, &[square(6.0)], (6.0, false));
    let up = Vec3::z() * 4.0;
    let free_m = 0.5 * 16.0 / 9.81;
    scars.active =
        Some(ActiveScar { depth_m: free_m + 2.0 * body.radius, ..scars.active.unwrap() });
    let dug = scars.active;
    for paid_m in [0.0, 0.3 * free_m, 2.0 * free_m] {
        scars.active = dug.map(|now| ActiveScar { prepaid: per_m * paid_m, ..now });
        let rise_m = free_m * scars.leave(&body, &up).powi(2);
        let unpaid_m = (rise_m - paid_m).max(0.0);
        let exact_m = free_m * math::exp(-2.0 * per_m * unpaid_m);
        assert!((rise_m / exact_m - 1.0).abs() < 1e-9, "{paid_m}: {rise_m} {exact_m}");
    }
    scars.active = dug;
    let first = scars.leave(&body, &up);
    scars.fly(&body, &(-up * first), 2.0 * 4.0 * first / 9.81);
    let second = scars.leave(&body, &up);
    assert!((second / first - 1.0).abs() < 1e-9, "{first}, then {second}");
}

/// A hop of a fraction of a micrometre is centimetres long where a ball skims over soil, and is
/// dragged over all of them: up to `h = h₀ exp(−2 k A h/c)` with the cut area `A` at the bottom and
/// the cosine `c` of the path to the normal.
#[test]
fn a_skimming_ball_is_dragged_along_its_way_and_not_its_rise() {
    let (body, mut scars, _) = deep(3000.0, 9.81);
    scars.enter(&body, &[square(10.0)], (10.0, false));
    let (now, v) = (scars.active.unwrap(), Vec3::new(200.0, 0.0, 2e-3));
    let (free_m, cosine) = (0.5 * v.z * v.z / 9.81, v.z / v.norm());
    assert!(free_m < 1e-6 * now.depth_m);
    let kept = scars.leave(&body, &v);
    let area_m2 = cut_area_m2(body.radius, now.depth_m, cosine);
    let drag = now.drag_per_m3 * area_m2 * kept * kept * free_m / cosine;
    assert!(drag > 1e-3 && (kept / math::exp(-drag) - 1.0).abs() < 1e-9, "{kept} {drag}");
}
