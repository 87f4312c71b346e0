//! How many rocks of each class of size and source come to a line.

use super::Line;
use crate::frequency::Frequency;
use crate::hazard::Proportion;
use serde::{Deserialize, Serialize};

/// A class of size and source at a line. Of one that nothing comes from, no mean and no percentile knows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClassReach {
    /// Name of the source.
    pub source: String,
    /// Smallest and largest volume (m³); none where the scene's rocks say how large they are.
    pub volume_m3: Option<[f64; 2]>,
    /// Events a year of the class (1/year).
    pub per_year: f64,
    /// Rocks of the class that were released.
    pub released: usize,
    /// Those of them that cross the line.
    pub reached: usize,
}

impl Line {
    /// The classes of a run, in order; none where all rocks are of one.
    pub fn by_class(&self, frequency: Option<&Frequency>) -> Vec<ClassReach> {
        let (Some(frequency), Some(weights)) = (frequency, &self.weights) else {
            return Vec::new();
        };
        let mut reached = vec![0; weights.strata()];
        for release in &self.releases {
            reached[weights.stratum_of(*release as usize)] += 1;
        }
        let class = |(number, reached): (usize, usize)| {
            let stratum = &frequency.strata()[number];
            ClassReach {
                source: frequency.sources()[stratum.source].name.clone(),
                volume_m3: stratum.volume_m3,
                per_year: stratum.per_year,
                released: weights.rocks(number),
                reached,
            }
        };
        reached.into_iter().enumerate().map(class).collect()
    }
}

/// Neighbours in size of one source, of which nothing comes to a line.
#[derive(Debug, Clone, PartialEq)]
pub struct SilentClasses {
    /// Name of the source.
    pub source: String,
    /// Smallest and largest volume (m³); none where the scene's rocks say how large they are.
    pub volume_m3: Option<[f64; 2]>,
    /// Share of their events that come: none seen of so many rocks, each of which stands for the events of its class, and at most what
    /// that and rocks that may still come leave open.
    pub reach: Proportion,
}

impl Line {
    /// Classes that were released and of which nothing comes, beside others that come: where nothing comes at all, the share of the line says so.
    pub fn silent(&self, frequency: Option<&Frequency>) -> Vec<SilentClasses> {
        let classes = self.by_class(frequency);
        let comes = classes.iter().any(|class| class.reached > 0);
        let Some(weights) = self.weights.as_ref().filter(|_| comes) else { return Vec::new() };
        let mut open = vec![0; classes.len()];
        for release in &self.open {
            open[weights.stratum_of(*release)] += 1;
        }
        let classes: Vec<(ClassReach, usize)> = classes.into_iter().zip(open).collect();
        without_arrival(&classes)
    }
}

/// The same of classes, each with how many of its rocks may still come.
fn without_arrival(classes: &[(ClassReach, usize)]) -> Vec<SilentClasses> {
    let is_silent = |(class, _): &(ClassReach, usize)| class.released > 0 && class.reached == 0;
    let goes_on = |one: &(ClassReach, usize), next: &(ClassReach, usize)| {
        is_silent(one) == is_silent(next)
            && one.0.source == next.0.source
            && are_neighbours([one.0.volume_m3, next.0.volume_m3])
    };
    let whole = |run: &[(ClassReach, usize)]| {
        let volumes = |(class, _): &(ClassReach, usize)| class.volume_m3;
        let ends = run.first().and_then(volumes).zip(run.last().and_then(volumes));
        SilentClasses {
            source: run[0].0.source.clone(),
            volume_m3: ends.map(|([low, _], [_, high])| [low, high]),
            reach: none_of(run),
        }
    };
    let runs = classes.chunk_by(goes_on);
    runs.filter(|run| is_silent(&run[0])).map(whole).collect()
}

/// Whether one class of size ends where the next begins: between others there are volumes that neither has.
fn are_neighbours(classes: [Option<[f64; 2]>; 2]) -> bool {
    let [Some([_, end]), Some([begin, _])] = classes else { return classes == [None; 2] };
    (end - begin).abs() <= 1e-9 * end
}

/// Share that comes of the events of silent classes, each with how many of its rocks may still come.
fn none_of(run: &[(ClassReach, usize)]) -> Proportion {
    let all_per_year: f64 = run.iter().map(|(class, _)| class.per_year).sum();
    let n = run.iter().map(|(class, _)| class.released).sum();
    let (mut heaviest, mut count, mut share, mut variance) = (0.0f64, 0, 0.0, 0.0);
    for (class, open) in run {
        let (own, rocks) = (class.per_year / all_per_year, class.released as f64);
        let part = *open as f64 / rocks;
        heaviest = heaviest.max(own / rocks);
        count += open;
        share += own * part;
        variance += own * own * part * (1.0 - part) / rocks;
    }
    let seen = Proportion::weighted((0, n), 0.0, (0.0, heaviest));
    if count == 0 {
        seen
    } else {
        seen.up_to(&Proportion::weighted((count, n), share, (variance, heaviest)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frequency::{Class, FrequencyLaw, RockSource};
    use crate::hazard::LineInfo;
    use crate::hazard::lines::tests::row;
    use crate::math;

    /// Of two sources with three classes and one, rock `i` is of class `i mod 4`: rocks 0, 4 and 7 cross.
    #[test]
    fn classes_that_do_not_come_are_counted() {
        let class = |low: f64| Class { volume_m3: [low, 2.0 * low], per_year: 0.1 };
        let source = |name: &str, lows: &[f64]| RockSource {
            name: name.to_owned(),
            law: FrequencyLaw::Classes(lows.iter().map(|low| class(*low)).collect()),
        };
        let sources = vec![source("wall", &[1.0, 2.0, 4.0]), source("gully", &[1.0])];
        let frequency = Frequency::new(sources, vec![], vec![]);
        let info = LineInfo {
            name: "road".to_owned(),
            length_m: 1.0,
            corners_m: Vec::new(),
            of_barrier: false,
            floor: None,
        };
        let mut line = Line::new(info).weighing(Some(frequency.weights(10)));
        for index in [0, 4, 7] {
            line.add(&row(index, "road", 0.0, 0.0, 1.0));
        }
        let classes = line.by_class(Some(&frequency));
        let counts: Vec<_> = classes.iter().map(|class| (class.reached, class.released)).collect();
        assert_eq!(counts, [(2, 3), (0, 3), (0, 2), (1, 2)]);
        let silent = line.silent(Some(&frequency));
        let said: Vec<_> =
            silent.iter().map(|one| (one.source.as_str(), one.volume_m3, one.reach.of)).collect();
        assert_eq!(said, [("wall", Some([2.0, 8.0]), 5)]);
        // two classes of equal frequency: a rock of the lesser sample stands for a quarter of both
        let open = |heaviest: f64| 1.0 - math::pow(0.05, heaviest);
        assert!((silent[0].reach.high_95 - open(0.25)).abs() < 1e-12, "{:?}", silent[0].reach);
        assert_eq!(line.by_class(None), []);
        assert_eq!(line.silent(None), []);
    }

    /// Classes that do not follow each other in size are said one by one: of 8 m³ and of 0.5 to 2 m³ nothing goes "from 8 to 2".
    #[test]
    fn classes_with_other_sizes_between_them_are_apart() {
        let class = |volume_m3: [f64; 2]| ClassReach {
            source: "pillar".to_owned(),
            volume_m3: Some(volume_m3),
            per_year: 0.1,
            released: 40,
            reached: 0,
        };
        let run = [[8.0, 8.0], [0.5, 2.0], [2.0, 4.0]].map(|volumes| (class(volumes), 0));
        let said: Vec<_> = without_arrival(&run).iter().map(|one| one.volume_m3).collect();
        assert_eq!(said, [Some([8.0, 8.0]), Some([0.5, 4.0])]);
    }

    /// A class that stands for nearly all events and has few rocks tells little, however many rocks the others have; and rocks that may still come are
    /// counted in the upper end.
    #[test]
    fn none_of_few_heavy_rocks_tells_little() {
        let class = |per_year: f64, released: usize| ClassReach {
            source: "wall".to_owned(),
            volume_m3: None,
            per_year,
            released,
            reached: 0,
        };
        let run = [(class(0.996, 20), 0), (class(0.004, 80), 0)];
        let silent = &without_arrival(&run)[0].reach;
        assert!((silent.high_95 - 0.139).abs() < 1e-3, "{silent:?}");
        assert!(!silent.censored && silent.of == 100);
        let alike = without_arrival(&[(class(0.5, 50), 0), (class(0.5, 50), 0)]);
        assert!((alike[0].reach.high_95 - Proportion::new(0, 100).high_95).abs() < 1e-12);
        let moving = &without_arrival(&[(class(0.996, 20), 19), (class(0.004, 80), 0)])[0].reach;
        assert!(moving.censored && moving.high_95 > 0.95, "{moving:?}");
    }
}
