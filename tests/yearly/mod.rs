//! Made-up crossings of a line by rocks of a known law.

#![allow(missing_docs, dead_code, unreachable_pub, clippy::unwrap_used)]

use rockfall::frequency::{Frequency, FrequencyLaw, RockSource, radius_of_m3};
use rockfall::hazard::{
    Annual, AnnualPlace, AnnualRequest, Barrier, CrossingRow, EventRate, LineInfo, annual,
};
use rockfall::random::{Purpose, stream, unit};
use std::convert::Infallible;

pub const DENSITY_KG_M3: f64 = 2700.0;
pub const SPEED_M_S: f64 = 20.0;
pub const REACH: f64 = 0.2;

/// N(≥ 1 m³) = 0.1 a year, exponent 0.5, 0.1 to 100 m³.
pub fn power_law(per_year_at_1m3: f64, exponent: f64) -> RockSource {
    let law = FrequencyLaw::PowerLaw { per_year_at_1m3, exponent, volume_m3: [0.1, 100.0] };
    RockSource { name: "wall".to_owned(), law }
}

pub fn asked(sources: Vec<RockSource>) -> AnnualRequest {
    let frequency = Frequency::new(sources, vec![300e3], vec![40.269_295_7, 100.0]);
    AnnualRequest { frequency: Some(frequency), ..AnnualRequest::default() }
}

pub fn row(index: usize, line: &str, volume_m3: f64, energy_j: f64) -> CrossingRow {
    CrossingRow {
        index,
        line: line.to_owned(),
        time_s: 2.0,
        along_m: 0.0,
        height_m: 0.0,
        speed_m_s: SPEED_M_S,
        translational_j: energy_j,
        rotational_j: 0.0,
        height_normal_m: 0.0,
        descent_deg: 0.0,
        mass_kg: DENSITY_KG_M3 * volume_m3,
        radius_m: radius_of_m3(volume_m3),
        times: 1,
        position_m: [0.0; 3],
        top_m: None,
    }
}

pub fn line(name: &str) -> LineInfo {
    LineInfo {
        name: name.to_owned(),
        length_m: 1.0,
        corners_m: vec![],
        of_barrier: false,
        floor: None,
    }
}

/// Rocks of a source that reach the line one time in five with 20 m/s.
pub fn crossings(asked: &AnnualRequest, seed: u64, releases: usize) -> Vec<CrossingRow> {
    let frequency = asked.frequency.as_ref().unwrap();
    let one = |index: usize| {
        let mut random = stream(seed, Purpose::Size, index);
        let volume_m3 = frequency.stratum(index).quantile_m3(unit(&mut random)).unwrap();
        let energy_j = 0.5 * DENSITY_KG_M3 * volume_m3 * SPEED_M_S * SPEED_M_S;
        (unit(&mut random) < REACH).then(|| row(index, "road", volume_m3, energy_j))
    };
    (0..releases).filter_map(one).collect()
}

pub fn year(
    asked: &AnnualRequest,
    releases: usize,
    rows: &[CrossingRow],
    barriers: &[Barrier],
) -> Annual {
    let rows = rows.iter().cloned().map(Ok::<_, Infallible>);
    annual(asked, releases, (&[line("road")], barriers), rows).unwrap().unwrap()
}

pub fn road(asked: &AnnualRequest, releases: usize, rows: &[CrossingRow]) -> AnnualPlace {
    year(asked, releases, rows, &[]).places.remove(0)
}

pub fn covers(rate: &EventRate, truth: f64) -> bool {
    (rate.low_95..=rate.high_95).contains(&truth)
}

pub fn near(found: f64, exact: f64, allowed: f64) {
    assert!((found / exact - 1.0).abs() <= allowed, "{found} for {exact}");
}
