//! Passages a year at lines and objects, with the barriers of the scene and without them.

use super::super::barriers::Barrier;
use super::super::classes::class_of;
use super::super::lines::{CrossingRow, LineFloor, LineInfo, by_rock};
use super::super::open::{OpenRock, OpenRocks};
use super::super::proportion::Proportion;
use super::super::rate::{ANY_ENERGY, EventRate, Limits, OpenSums, Running, Sums, proportion};
use super::AnnualRequest;
use super::barriers::{AnnualBarrier, Met};
use super::curve::{
    Ceilings, ExceedancePoint, ReturnEnergy, UnseenPoint, curve, resolved, return_energy,
};
use super::energies::EnergyCounts;
use super::risk::{Object, Risk};
use super::strata::{All, StratumSums, stratum_of};
use crate::frequency::{Frequency, Weights};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Annual frequencies and energies at every line and object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Annual {
    /// Events a year of all sources (1/year).
    pub events_per_year: f64,
    /// Rocks computed: those that were released.
    pub rocks: usize,
    /// Number of equally weighted rocks that would give the same precision (–).
    pub effective_rocks: f64,
    /// Strata that they were drawn from.
    pub strata: usize,
    /// Lines and objects, in the order of the scene.
    pub places: Vec<AnnualPlace>,
    /// Barriers, in the order of the scene.
    #[serde(default)]
    pub barriers: Vec<AnnualBarrier>,
}

/// One line or object.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AnnualPlace {
    /// Its name.
    pub name: String,
    /// Whether it is an object.
    pub is_object: bool,
    /// Share of all events that reach it: conditional on release, not a year.
    pub conditional_on_release: Proportion,
    /// As if there were no barrier.
    pub without_barriers: AnnualFigures,
    /// Of the rocks that no barrier stops before; none where the scene has no barrier.
    pub with_barriers: Option<AnnualFigures>,
    /// What each barrier keeps away: the first that stops a rock counts.
    pub saved: Vec<Saved>,
}

/// What a year brings to a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AnnualFigures {
    /// Rocks that pass: of a line those that cross it, of an object those that hit it.
    pub passages: EventRate,
    /// The same with at least an energy, for each that is asked for.
    pub above: Vec<Above>,
    /// The energy of each return period asked for.
    pub returns: Vec<ReturnEnergy>,
    /// Risks of an object.
    pub risks: Vec<Risk>,
    /// λ(E ≥ e), by falling energy.
    pub curve: Vec<ExceedancePoint>,
    /// How often more energy may come than any rock had; none in files that do not tell it.
    #[serde(default)]
    pub unseen: Vec<UnseenPoint>,
}

/// Passages with at least an energy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Above {
    /// Total energy (J).
    pub energy_j: f64,
    /// How often.
    pub rate: EventRate,
}

/// What a barrier keeps away from a place.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Saved {
    /// Name of the barrier.
    pub barrier: String,
    /// Passages that do not happen.
    pub passages: EventRate,
    /// The same with at least an energy.
    pub above: Vec<Above>,
    /// Risks of an object that it takes away.
    #[serde(default)]
    pub risks: Vec<Risk>,
}

/// Passages of one place that have something in common.
#[derive(Debug, Default)]
struct PassageTally {
    /// All, and above each energy asked for.
    above: Vec<StratumSums>,
    /// Metres of road blocked.
    blocked: StratumSums,
    classes: BTreeMap<(u16, u16), Sums>,
    /// Their energies, for those that one rock decides; none of what a barrier keeps away, of which no energy is told.
    energies: EnergyCounts,
    /// Rocks that may still pass, and the metres of road that they would block.
    open: OpenSums,
    open_blocked: OpenSums,
}

/// One passage.
struct PlacePassage {
    stratum: u16,
    score: f64,
    total_j: f64,
    blocked_m: f64,
}

impl PassageTally {
    fn add(&mut self, passage: &PlacePassage, energies_j: &[f64]) {
        let PlacePassage { stratum, score, total_j, blocked_m } = *passage;
        let one = Sums::one(1.0, score);
        self.above.resize(energies_j.len() + 1, StratumSums::default());
        for (strata, least_j) in self.above.iter_mut().zip([0.0].iter().chain(energies_j)) {
            if total_j >= *least_j {
                strata.entry(stratum).or_default().join(&one);
            }
        }
        self.blocked.entry(stratum).or_default().join(&Sums::one(blocked_m, score));
        self.classes.entry((class_of(total_j), stratum)).or_default().join(&one);
    }

    /// Notes a rock that may still pass; its energy is the most that it can have.
    fn leave_open(&mut self, passage: &PlacePassage) {
        let PlacePassage { stratum, total_j, blocked_m, .. } = *passage;
        let class = if total_j.is_finite() { class_of(total_j) } else { ANY_ENERGY };
        self.open.entry((class, stratum)).or_default().join(&Sums::one(1.0, 0.0));
        let blocked = self.open_blocked.entry((ANY_ENERGY, stratum)).or_default();
        blocked.join(&Sums::one(blocked_m, 0.0));
    }

    fn rate(&self, level: usize, all: &All<'_>) -> EventRate {
        let energies = all.frequency.energies_j();
        let least_j = level.checked_sub(1).map_or(0.0, |k| energies[k]);
        let limits = Limits::above(&all.weights, &all.asked.most_j, least_j);
        all.rate((self.above.get(level), &self.open), &limits)
    }

    fn above(&self, all: &All<'_>) -> Vec<Above> {
        let above = |(k, &energy_j): (usize, &f64)| Above { energy_j, rate: self.rate(k + 1, all) };
        all.frequency.energies_j().iter().enumerate().map(above).collect()
    }

    fn figures(&self, object: Option<&Object>, all: &All<'_>) -> AnnualFigures {
        let passages = self.rate(0, all);
        let falling = self.classes.iter().rev().map(|(&(class, at), sums)| (class, at, *sums));
        let mut running = Running::with_open(&all.weights, &self.open);
        let own = (!self.open.is_empty())
            .then(|| Ceilings::beside(&running, (&all.weights, &all.asked.most_j)));
        let ceilings = own.as_ref().unwrap_or(&all.ceilings);
        let smooth = curve(falling, &mut running, ceilings);
        let periods = all.frequency.return_periods_years();
        let steps = resolved((&smooth, &self.energies.falling()), &mut running, ceilings, periods);
        let energy =
            |years: &f64| return_energy((&steps, &smooth), ceilings, *years, all.has_exponent);
        let returns = periods.iter().map(energy).collect();
        let risks = self.risks(object, all);
        let least = self.classes.keys().next().map_or(0, |(class, _)| *class);
        let seen = smooth.iter().filter(|step| step.class >= least);
        let curve = seen.map(|step| step.point).collect();
        let unseen = ceilings.unseen_above(&smooth);
        AnnualFigures { passages, above: self.above(all), returns, risks, curve, unseen }
    }

    /// Risks of an object by the rocks that hit it.
    fn risks(&self, object: Option<&Object>, all: &All<'_>) -> Vec<Risk> {
        let Some(object) = object else { return Vec::new() };
        // no rock of a stratum blocks more than its largest, seen or not
        let longest_m = |stratum: usize| object.blocked_m(2.0 * all.asked.largest_m(stratum));
        let limits = Limits::weighing(&all.weights, longest_m);
        object.risks(
            &self.rate(0, all),
            &all.rate((Some(&self.blocked), &self.open_blocked), &limits),
        )
    }
}

/// Sums of one line or object.
#[derive(Debug)]
struct PlaceSums {
    name: String,
    floor: Option<LineFloor>,
    object: Option<Object>,
    all: PassageTally,
    unstopped: PassageTally,
    saved: Vec<PassageTally>,
}

/// What a year brings, while rocks come in: sums by stratum and class of energy, which do not grow with the rocks.
#[derive(Debug)]
pub struct YearSums {
    asked: AnnualRequest,
    frequency: Frequency,
    barriers: Vec<Barrier>,
    places: Vec<PlaceSums>,
    nets: Vec<Met>,
}

impl YearSums {
    /// Without rocks; none without sources.
    pub fn new(asked: &AnnualRequest, lines: &[LineInfo], barriers: &[Barrier]) -> Option<Self> {
        let frequency = asked.frequency.clone()?;
        let shown = lines.iter().filter(|line| !line.of_barrier);
        Some(Self {
            asked: asked.clone(),
            frequency,
            barriers: barriers.to_vec(),
            places: shown.map(|line| PlaceSums::of(line, &asked.objects, barriers.len())).collect(),
            nets: barriers.iter().map(|_| Met::default()).collect(),
        })
    }

    /// Notes all first crossings of one rock, and which of them a barrier prevents. The rows are put in the order of time.
    pub fn add(&mut self, rock: &mut [CrossingRow]) {
        let Self { frequency, barriers, places, nets, .. } = self;
        rock.sort_by(|one, other| one.time_s.total_cmp(&other.time_s));
        let stop = rock.iter().find_map(|row| {
            let which = barriers.iter().position(|barrier| barrier.name == row.line)?;
            let stops = nets[which].add(&barriers[which], row, frequency);
            stops.then_some((row.time_s, which))
        });
        for row in rock.iter() {
            let place = places.iter_mut().find(|place| place.name == row.line);
            let Some(place) = place else { continue };
            place.add(row, stop.filter(|(time_s, _)| row.is_behind(*time_s)), frequency);
        }
    }

    /// Notes the rocks that may still come to lines, objects and barriers.
    pub fn leave_open(&mut self, open: &OpenRocks) {
        let Self { asked, frequency, barriers, places, nets } = self;
        for (which, (barrier, net)) in barriers.iter().zip(nets).enumerate() {
            net.leave_open(open.free_at(&barrier.name, Some(which)), frequency);
        }
        for place in places {
            let own = barriers.iter().position(|barrier| barrier.name == place.name);
            for rock in open.rocks_at(&place.name) {
                place.leave_open(rock, own, (frequency, &asked.most_j));
            }
        }
    }

    /// What they say where rocks stand for so much.
    pub fn said(&self, weights: Weights) -> Annual {
        let Self { asked, frequency, barriers, places, nets } = self;
        let has_exponent = frequency.strata().iter().any(|stratum| stratum.exponent.is_some());
        let ceilings = Ceilings::of(&weights, &asked.most_j);
        let all = All { asked, frequency, weights, ceilings, has_exponent, barriers };
        Annual {
            events_per_year: frequency.per_year(),
            rocks: all.weights.all_rocks(),
            effective_rocks: all.weights.effective_rocks(),
            strata: frequency.strata().len(),
            places: places.iter().map(|place| place.said(&all)).collect(),
            barriers: barriers.iter().zip(nets).map(|(one, met)| met.said(one, &all)).collect(),
        }
    }
}

/// What a year brings, from first crossings that come release by release, all of which were released; none without sources.
///
/// # Errors
/// Passes on what reading a row says.
pub fn annual<E>(
    asked: &AnnualRequest,
    releases: usize,
    (lines, barriers): (&[LineInfo], &[Barrier]),
    rows: impl Iterator<Item = Result<CrossingRow, E>>,
) -> Result<Option<Annual>, E> {
    let Some(mut year) = YearSums::new(asked, lines, barriers) else { return Ok(None) };
    by_rock(rows, |rock| year.add(rock))?;
    let weights = year.frequency.weights(releases);
    Ok(Some(year.said(weights)))
}

impl PlaceSums {
    fn of(line: &LineInfo, objects: &[Object], barriers: usize) -> Self {
        Self {
            name: line.name.clone(),
            floor: line.floor,
            object: objects.iter().find(|object| object.name == line.name).cloned(),
            all: PassageTally::default(),
            unstopped: PassageTally::default(),
            saved: (0..barriers).map(|_| PassageTally::default()).collect(),
        }
    }

    fn add(&mut self, row: &CrossingRow, stopped: Option<(f64, usize)>, frequency: &Frequency) {
        let (stratum, score) = stratum_of(frequency, row);
        let blocked_m =
            self.object.as_ref().map_or(0.0, |object| object.blocked_m(2.0 * row.radius_m));
        let passage = PlacePassage { stratum, score, total_j: row.total_j(), blocked_m };
        let energies_j = frequency.energies_j();
        self.all.add(&passage, energies_j);
        self.all.energies.add(passage.total_j, stratum);
        match stopped {
            None => {
                self.unstopped.add(&passage, energies_j);
                self.unstopped.energies.add(passage.total_j, stratum);
            }
            Some((_, which)) => self.saved[which].add(&passage, energies_j),
        }
    }

    /// Notes a rock that may still come: a barrier that has stopped it, or one further on, may keep it away.
    fn leave_open(
        &mut self,
        rock: &OpenRock,
        own: Option<usize>,
        (frequency, most_j): (&Frequency, &[f64]),
    ) {
        let stratum = frequency.stratum_of(rock.release) as u16;
        let blocked_m =
            self.object.as_ref().map_or(0.0, |object| object.blocked_m(2.0 * rock.radius_m));
        let of_class_j = most_j.get(usize::from(stratum)).copied().unwrap_or(f64::INFINITY);
        let total_j = self.floor.map_or(of_class_j, |floor| rock.most_j(floor).min(of_class_j));
        let passage = PlacePassage { stratum, score: 0.0, total_j, blocked_m };
        self.all.leave_open(&passage);
        if let Some(which) = rock.stopped_by(own) {
            self.saved[which].leave_open(&passage);
        } else {
            self.unstopped.leave_open(&passage);
            self.saved.iter_mut().for_each(|saved| saved.leave_open(&passage));
        }
    }

    fn said(&self, all: &All<'_>) -> AnnualPlace {
        let rocks = |sums: &Sums| sums.rocks();
        let reach = self.all.above.first().into_iter().flatten();
        let saved = |(barrier, tally): (&Barrier, &PassageTally)| Saved {
            barrier: barrier.name.clone(),
            passages: tally.rate(0, all),
            above: tally.above(all),
            risks: tally.risks(self.object.as_ref(), all),
        };
        let judged = !all.barriers.is_empty();
        let share = |sums: &mut dyn Iterator<Item = (&u16, &Sums)>| {
            proportion(&all.weights, sums.map(|(stratum, sums)| (*stratum, rocks(sums))))
        };
        let seen = share(&mut reach.clone());
        let open = &self.all.open;
        let with_open = reach.chain(open.iter().map(|((_, stratum), sums)| (stratum, sums)));
        let conditional =
            if open.is_empty() { seen } else { seen.up_to(&share(&mut { with_open })) };
        AnnualPlace {
            name: self.name.clone(),
            is_object: self.object.is_some(),
            conditional_on_release: conditional,
            without_barriers: self.all.figures(self.object.as_ref(), all),
            with_barriers: judged.then(|| self.unstopped.figures(self.object.as_ref(), all)),
            saved: all.barriers.iter().zip(&self.saved).map(saved).collect(),
        }
    }
}
