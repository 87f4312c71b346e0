//! Whose values are compared: all releases, and those that come to each line and barrier that both runs have.

use super::weighing::{self, CountedReleases};
use crate::error::Result;
use crate::hazard::{
    self, Barrier, CrossingRow, Quantity, Reading, Row, RowBounds, Sample, StopKind, Values,
    WeightedCount,
};
use crate::output::Results;
use crate::report::planned;
use std::ops::Range;
use std::sync::Arc;

/// Some rocks of one run.
#[derive(Debug, Clone, Default)]
pub(super) struct Population {
    /// What they are: a heading.
    pub(super) name: String,
    /// Whether they are what the barriers of a run have let through.
    pub(super) is_behind_barriers: bool,
    /// Released rocks that they are among.
    pub(super) among: Arc<CountedReleases>,
    pub(super) shares: Vec<CountedShare>,
    /// Quantities: what, and its value for each release that has one.
    pub(super) values: Vec<(ComparedQuantity, Values)>,
    /// Releases that would have gone on, of whole ways, and which values of theirs are bounds.
    pub(super) open: Vec<(usize, RowBounds)>,
    /// Whether they are of a run without trees: none touches one, however far it goes on.
    pub(super) has_no_trees: bool,
}

/// A share of some releases of a run.
#[derive(Debug, Clone)]
pub(super) struct CountedShare {
    pub(super) name: String,
    /// Those that count, by rising number.
    pub(super) releases: Vec<usize>,
    /// All that could.
    pub(super) among: Arc<CountedReleases>,
    /// Whether they come to a place, so that their number a year is asked for too.
    pub(super) come: bool,
    /// Those that may still count: they would have gone on.
    pub(super) open: Vec<usize>,
}

impl CountedShare {
    /// With what they stand for; none where all weigh the same.
    pub(super) fn weighted(&self) -> Option<WeightedCount<'_>> {
        let weights = &self.among.standing.as_ref()?.weights;
        Some(WeightedCount { releases: &self.releases, among: &self.among.releases, weights })
    }

    /// The same of those that come to a place, where they stand for events a year.
    pub(super) fn in_a_year(&self) -> Option<WeightedCount<'_>> {
        let is_a_year = self.among.standing.as_ref()?.is_a_year;
        self.weighted().filter(|_| is_a_year && self.come)
    }

    /// Of all that could (–).
    pub(super) fn share(&self) -> f64 {
        match &self.among.standing {
            None => self.releases.len() as f64 / self.among.releases.len().max(1) as f64,
            Some(of) => hazard::share_of(&of.weights, self.releases.iter().copied()).share,
        }
    }
}

impl Population {
    /// Whether it is that of another run rock by rock, and no barrier has a part in it.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let is_alike = |(own, other): (&CountedShare, &CountedShare)| {
            own.releases == other.releases && own.open == other.open
        };
        self.shares.len() == other.shares.len()
            && self.shares.iter().zip(&other.shares).all(is_alike)
            && !self.is_behind_barriers
            && self.among == other.among
            && self.values == other.values
            && self.open == other.open
    }

    pub(super) fn mean(&self, values: &Values) -> Option<Reading> {
        match &self.among.standing {
            None => Reading::mean(values),
            Some(of) => Reading::weighted_mean(values, &of.weights),
        }
    }

    pub(super) fn percentile(&self, values: &Values, p: f64) -> Option<Reading> {
        match &self.among.standing {
            None => Reading::percentile(values, p),
            Some(of) => Reading::weighted_percentile(values, &of.weights, p),
        }
    }

    /// The values in another unit, sorted.
    pub(super) fn sample(&self, values: &Values, size: f64) -> Sample {
        match &self.among.standing {
            None => Sample::of(values.iter().map(|(_, x)| x / size)),
            Some(of) => {
                let each = values.iter().map(|&(release, x)| (x / size, release));
                Sample::of_releases(each, &of.weights)
            }
        }
    }

    /// The same where those of rocks that would have gone on are bounds on that side; of a rock that has left no number nothing is known.
    pub(super) fn censored_sample(&self, values: &Values, quantity: Quantity) -> Sample {
        let bounds = self.open.iter().filter(|(_, bounds)| bounds.has(quantity));
        let open: Vec<usize> = bounds.map(|of| of.0).collect();
        let is_open = |release: usize| open.binary_search(&release).is_ok();
        let has_none = |release: &&usize| values.binary_search_by_key(*release, |of| of.0).is_err();
        let unknown = open.iter().filter(has_none).map(|&at| (f64::NAN, at, true));
        let each = values.iter().map(|&(at, x)| (x, at, is_open(at))).chain(unknown);
        let side = quantity.open();
        match &self.among.standing {
            None => Sample::censored(each.map(|(x, _, is_open)| (x, 1.0, is_open)), side),
            Some(of) => Sample::censored_of_releases(each, &of.weights, side),
        }
    }
}

/// A quantity that is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ComparedQuantity {
    /// Of a whole way.
    Whole(Quantity),
    /// Total energy (J).
    Energy,
    /// Height of the lowest point (m).
    Height,
    /// Height of the highest point (m).
    Top,
    /// Speed (m/s).
    Speed,
}

impl ComparedQuantity {
    /// Name, unit and its size in SI.
    pub(super) fn words(self) -> (&'static str, &'static str, f64) {
        match self {
            Self::Whole(Quantity::Runout) => ("Runout", "m", 1.0),
            Self::Whole(Quantity::Drop) => ("Drop", "m", 1.0),
            Self::Whole(Quantity::ReachAngle) => ("Reach angle", "°", 1.0),
            Self::Whole(Quantity::MaxSpeed) => ("Largest speed", "m/s", 1.0),
            Self::Whole(Quantity::MaxTranslational) => ("Largest translational energy", "kJ", 1e3),
            Self::Whole(Quantity::MaxRotational) => ("Largest rotational energy", "kJ", 1e3),
            Self::Whole(Quantity::MaxTotal) => ("Largest total energy", "kJ", 1e3),
            Self::Whole(Quantity::MaxHeight) => ("Largest bounce height", "m", 1.0),
            Self::Whole(Quantity::Impacts) => ("Impacts a rock", "", 1.0),
            Self::Whole(Quantity::TreeImpacts) => ("Impacts on trees a rock", "", 1.0),
            Self::Whole(Quantity::Time) => ("Time to the end", "s", 1.0),
            Self::Energy => ("Total energy", "kJ", 1e3),
            Self::Height => ("Height of the lowest point", "m", 1.0),
            Self::Top => ("Height of the highest point", "m", 1.0),
            Self::Speed => ("Speed", "m/s", 1.0),
        }
    }

    /// Whether it is a count: its percentiles stand on steps, and only its mean is compared.
    pub(super) fn is_count(self) -> bool {
        matches!(self, Self::Whole(Quantity::Impacts | Quantity::TreeImpacts))
    }
}

/// Quantities of all releases.
const WHOLE: [Quantity; 7] = [
    Quantity::Runout,
    Quantity::ReachAngle,
    Quantity::MaxSpeed,
    Quantity::MaxTotal,
    Quantity::MaxHeight,
    Quantity::Impacts,
    Quantity::TreeImpacts,
];

/// The populations of both runs, pair by pair, and what is in one of them only.
pub(super) fn of(
    runs: &[Results; 2],
    ranges: &[Range<usize>; 2],
    paired: bool,
) -> Result<(Vec<[Population; 2]>, Vec<String>)> {
    let whole = CountedReleases::of(runs, ranges, ranges.clone().map(Iterator::collect));
    let among = CountedReleases::of(runs, ranges, weighing::released(runs, ranges, paired)?);
    let [one, other] = [0, 1].map(|k| all(&runs[k], (&whole[k], &among[k])));
    let mut pairs = vec![[one?, other?]];
    let mut notes = Vec::new();
    notes.extend(not_released(&whole, &among));
    let lines = |run: &Results| -> Vec<String> {
        run.lines_of_scene().map(|line| line.info.name.clone()).collect()
    };
    let [one, other] = [lines(&runs[0]), lines(&runs[1])];
    for (who, mine, others) in [("A", &one, &other), ("B", &other, &one)] {
        let alone: Vec<&str> =
            mine.iter().filter(|name| !others.contains(name)).map(String::as_str).collect();
        if !alone.is_empty() {
            notes.push(format!("Only in {who}: {}.", alone.join(", ")));
        }
    }
    let both: Vec<String> = one.into_iter().filter(|name| other.contains(name)).collect();
    let [one, other] = [0, 1].map(|k| at_lines(&runs[k], &both, &among[k]));
    let (one, other) = (one?, other?);
    for (a, b) in one.into_iter().zip(other) {
        let stops = a.barriers_stop || b.barriers_stop;
        pairs.push([a.crossing, b.crossing]);
        // where no barrier stops anything before the line or at it, the same numbers would stand twice
        pairs.extend(stops.then_some([a.arriving, b.arriving]));
    }
    Ok((pairs, notes))
}

/// The rocks at a line, with and without the barriers.
struct AtLine {
    crossing: Population,
    arriving: Population,
    /// Whether a barrier stops some before it, or stands on it.
    barriers_stop: bool,
}

/// What is said of rocks that one of the runs did not release; nothing where there are none.
fn not_released(
    whole: &[Arc<CountedReleases>; 2],
    among: &[Arc<CountedReleases>; 2],
) -> Option<String> {
    let [a, b] = [0, 1].map(|k| whole[k].releases.len() - among[k].releases.len());
    (a + b > 0).then(|| {
        format!(
            "{a} rocks of A and {b} of B count only among the ways in which rocks end: they were not released, or the same rock \
             of the other run was not."
        )
    })
}

/// All releases of a run: `whole` end in some way, `among` are the released ones that have values.
fn all(
    run: &Results,
    (whole, among): (&Arc<CountedReleases>, &Arc<CountedReleases>),
) -> Result<Population> {
    let share = |stop: StopKind| CountedShare {
        name: ended(stop).to_owned(),
        releases: Vec::new(),
        among: Arc::clone(whole),
        come: false,
        open: Vec::new(),
    };
    let mut found = Population {
        name: "All releases".to_owned(),
        is_behind_barriers: false,
        among: Arc::clone(among),
        shares: StopKind::ALL.map(share).into(),
        values: WHOLE.map(|quantity| (ComparedQuantity::Whole(quantity), Values::new())).into(),
        open: Vec::new(),
        has_no_trees: planned::is_left_out(&run.summary.plan_entries, "trees"),
    };
    for row in run.rows()? {
        let row: Row = row?;
        if !whole.contains(row.index) {
            continue;
        }
        let stop = StopKind::ALL.iter().position(|stop| *stop == row.stop).unwrap_or(0);
        found.shares[stop].releases.push(row.index);
        if among.contains(row.index) {
            let bounds = RowBounds::of(&row, run.summary.site.floor);
            found.open.extend(row.stop.is_open().then_some((row.index, bounds)));
            for ((_, values), quantity) in found.values.iter_mut().zip(WHOLE) {
                // a failed rock may have left no number
                let value = Some(quantity.of(&row)).filter(|value| value.is_finite());
                values.extend(value.map(|value| (row.index, value)));
            }
        }
    }
    Ok(found)
}

fn ended(stop: StopKind) -> &'static str {
    match stop {
        StopKind::AtRest => "Come to rest",
        StopKind::LeftTerrain => "Left the terrain",
        StopKind::TimeUp => "Still moving at the end",
        StopKind::OverBudget => "Still moving when the work was spent",
        StopKind::Failed => "Failed",
        StopKind::NotReleased => "Not released",
    }
}

/// The rocks that come to each of some lines: all that cross, and where there are barriers those that the barriers
/// before have let through.
fn at_lines(run: &Results, names: &[String], among: &Arc<CountedReleases>) -> Result<Vec<AtLine>> {
    let rows: Vec<CrossingRow> = run
        .crossings()?
        .filter(|row| row.as_ref().map_or(true, |row| among.contains(row.index)))
        .collect::<Result<_>>()?;
    let barriers: Vec<Barrier> =
        run.summary.barriers.iter().map(|one| one.barrier.clone()).collect();
    let arrived = arrived(&barriers, names, &rows)?;
    let mut found = Vec::new();
    for (name, arrived) in names.iter().zip(arrived) {
        let mine = |rock: &usize| among.contains(*rock);
        let may_come = run.open.at(name).filter(mine).collect();
        let may_arrive = run.open.behind_barriers(name).filter(mine).collect();
        let crossing = crossing((name, run.is_object(name)), &rows, &(among, may_come));
        let is_barrier = barriers.iter().any(|barrier| barrier.name == *name);
        let barriers_stop = is_barrier || arrived.len() < crossing.shares[0].releases.len();
        let arriving = arriving(name, (&barriers, &arrived), &(among, may_arrive));
        found.push(AtLine { crossing, arriving, barriers_stop });
    }
    Ok(found)
}

/// Released rocks, and those of them that may still come to a place.
type AmongOpen<'a> = (&'a Arc<CountedReleases>, Vec<usize>);

/// A share of the released rocks at a place.
fn at_place(
    name: &str,
    releases: Vec<usize>,
    ((among, open), come): (&AmongOpen, bool),
) -> CountedShare {
    let (name, open) = (name.to_owned(), open.clone());
    CountedShare { name, releases, among: Arc::clone(among), come, open }
}

fn crossing(
    (name, is_object): (&str, bool),
    rows: &[CrossingRow],
    among: &AmongOpen,
) -> Population {
    let (what, come) = if is_object { ("Object", "Hit it") } else { ("Line", "Cross it") };
    let own = || rows.iter().filter(|row| row.line == name);
    let values = |of: fn(&CrossingRow) -> f64| own().map(|row| (row.index, of(row))).collect();
    let cross = own().map(|row| row.index).collect();
    Population {
        name: format!("{what} “{name}”, barriers left aside"),
        among: Arc::clone(among.0),
        shares: vec![at_place(come, cross, (among, true))],
        values: vec![
            (ComparedQuantity::Energy, values(CrossingRow::total_j)),
            (ComparedQuantity::Height, values(|row| row.height_m)),
            (ComparedQuantity::Speed, values(|row| row.speed_m_s)),
        ],
        ..Population::default()
    }
}

fn arriving(
    name: &str,
    (barriers, arrived): (&[Barrier], &[hazard::Arrival]),
    among: &AmongOpen,
) -> Population {
    let releases = |keep: &dyn Fn(&hazard::Arrival) -> bool| {
        arrived.iter().filter(|rock| keep(rock)).map(|rock| rock.release).collect()
    };
    let mut shares = vec![at_place("Arrive", releases(&|_| true), (among, true))];
    if let Some(barrier) = barriers.iter().find(|barrier| barrier.name == name) {
        let passes =
            |rock: &hazard::Arrival| !rock.is_stopped(barrier.height_m, barrier.capacity_j);
        shares.push(at_place("Pass it", releases(&passes), (among, false)));
    }
    let values = |of: fn(&hazard::Arrival) -> f64| {
        arrived.iter().map(|rock| (rock.release, of(rock))).collect()
    };
    Population {
        name: format!("“{name}”, behind the barriers of each run"),
        is_behind_barriers: true,
        among: Arc::clone(among.0),
        shares,
        values: vec![
            (ComparedQuantity::Energy, values(|rock| rock.total_j)),
            (ComparedQuantity::Top, values(|rock| rock.top_m)),
        ],
        ..Population::default()
    }
}

/// Rocks that arrive at each of some lines, those left out that a barrier before has stopped.
fn arrived(
    barriers: &[Barrier],
    names: &[String],
    rows: &[CrossingRow],
) -> Result<Vec<Vec<hazard::Arrival>>> {
    // a line is a barrier that stops nothing: every rock's highest point is above its edge
    let line = |name: &String| Barrier {
        name: name.clone(),
        height_m: 0.0,
        capacity_j: 0.0,
        design: None,
        elsewhere: Vec::new(),
    };
    let stand = |name: &&String| barriers.iter().all(|barrier| barrier.name != **name);
    let all: Vec<Barrier> =
        barriers.iter().cloned().chain(names.iter().filter(stand).map(line)).collect();
    let mut found = hazard::arrivals(&all, rows.iter().cloned().map(Ok::<_, crate::error::Error>))?;
    let own = |name: &String| all.iter().position(|barrier| barrier.name == *name);
    let mut places = |name: &String| {
        let mut rocks = own(name).map(|k| std::mem::take(&mut found[k][0])).unwrap_or_default();
        rocks.sort_by_key(|rock| rock.release);
        rocks
    };
    Ok(names.iter().map(&mut places).collect())
}
