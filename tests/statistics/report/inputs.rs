//! Reports to draw: of every size, of one rock, of rocks that left.

use super::*;

/// What a report may be fed: the common and the odd.
pub(super) fn inputs() -> Vec<(&'static str, Report)> {
    let full = slope::report(1000, 300);
    let one = slope::report(1, 1);
    vec![
        ("full", full.clone()),
        ("empty", Report::default()),
        ("one_release", one.clone()),
        ("no_path", Report { paths: Vec::new(), ..slope::report(30, 0) }),
        ("no_ground", Report { ground: None, ..full.clone() }),
        ("no_motion", slope::filled(Report { releases: vec![still(); 20], ..Report::default() })),
        ("one_point", slope::filled(Report { paths: vec![one_point()], ..one.clone() })),
        ("not_numbers", slope::filled(broken(full))),
        ("huge", slope::filled(stretched(one, 1e7))),
        ("small", small()),
        ("all_ends", slope::filled(all_ends(slope::report(400, 20)))),
        ("barriers", Report { barriers: vec![net(60), net(0)], ..slope::report(30, 5) }),
        ("site", places::site()),
        ("left", left()),
    ]
}

/// A rock that stays where it is released.
pub(super) fn still() -> ReleaseEnd {
    ReleaseEnd {
        stop: Stop::AtRest,
        runout_m: 0.0,
        drop_m: 0.0,
        reach_angle_deg: 0.0,
        max_speed_m_s: 0.0,
        max_translational_j: 0.0,
        max_rotational_j: 0.0,
        max_total_j: 0.0,
        max_height_m: 0.0,
        impacts: 0,
        tree_impacts: 0,
        start_m: [2_600_000.0, 1_200_000.0, 500.0],
        end_m: [2_600_000.0, 1_200_000.0, 500.0],
    }
}

pub(super) fn one_point() -> Path {
    let place_m = [2_600_050.0, 1_200_100.0, 900.0];
    let state = PathState::Flight;
    Path {
        index: 0,
        points: vec![ReportPathPoint {
            time_s: 0.0,
            place_m,
            speed_m_s: 0.0,
            clearance_m: 0.0,
            state,
        }],
    }
}

/// Values that a failed rock may leave behind.
pub(super) fn broken(mut report: Report) -> Report {
    for (i, fall) in report.releases.iter_mut().enumerate() {
        match i % 5 {
            0 => fall.runout_m = f64::NAN,
            1 => fall.end_m = [f64::NAN; 3],
            2 => fall.max_speed_m_s = f64::INFINITY,
            3 => fall.max_total_j = f64::NEG_INFINITY,
            _ => fall.reach_angle_deg = f64::NAN,
        }
    }
    for path in &mut report.paths {
        for (i, point) in path.points.iter_mut().enumerate() {
            match i % 7 {
                0 => point.clearance_m = f64::NAN,
                3 => point.speed_m_s = f64::NAN,
                5 => point.place_m[i % 3] = f64::NAN,
                _ => {}
            }
        }
    }
    report
}

pub(super) fn stretched(mut report: Report, factor: f64) -> Report {
    let fall = &mut report.releases[0];
    fall.end_m[0] += factor;
    fall.runout_m = factor;
    fall.max_total_j *= factor;
    report
}

/// Every way to end, often: the longest key a map can have.
pub(super) fn all_ends(mut report: Report) -> Report {
    let stops = [Stop::AtRest, Stop::LeftTerrain, Stop::TimeUp, Stop::Failed("made".to_owned())];
    report.releases = vec![report.releases; 10].concat();
    for (i, fall) in report.releases.iter_mut().enumerate() {
        fall.stop = stops[i % 4].clone();
        // a narrow map leaves the key little room
        fall.start_m[0] = 2_600_070.0;
        fall.end_m[0] = 2_600_070.0 + (i % 9) as f64;
    }
    Report { ground: None, paths: Vec::new(), ..report }
}

/// Most rocks leave the terrain: runout is open upwards, the reach angle downwards.
pub(super) fn left() -> Report {
    let mut report = slope::report(400, 40);
    report.releases.iter_mut().step_by(2).for_each(|fall| fall.stop = Stop::LeftTerrain);
    let mut report = slope::filled(report);
    report.runout_exceedance.truncate(60);
    for (quantity, is) in
        [(ReportQuantity::Runout, Is::AtLeast), (ReportQuantity::ReachAngle, Is::AtMost)]
    {
        for quantile in report.quantiles.get_mut(&quantity).into_iter().flatten() {
            let at = &mut quantile.at;
            at.is = is;
            if is == Is::AtLeast { at.high = f64::NAN } else { at.low = f64::NAN }
        }
    }
    report
}

/// A table-top experiment: everything within a metre, at the origin.
pub(super) fn small() -> Report {
    let mut report = slope::report(40, 40);
    let shrink = |p: [f64; 3]| [(p[0] - 2.6e6) * 1e-3, (p[1] - 1.2e6) * 1e-3, p[2] * 1e-3];
    for fall in &mut report.releases {
        (fall.start_m, fall.end_m) = (shrink(fall.start_m), shrink(fall.end_m));
        fall.runout_m *= 1e-3;
        fall.max_total_j *= 1e-9;
    }
    for point in report.paths.iter_mut().flat_map(|path| &mut path.points) {
        point.place_m = shrink(point.place_m);
        point.clearance_m *= 1e-3;
    }
    slope::filled(Report { ground: None, ..report })
}
