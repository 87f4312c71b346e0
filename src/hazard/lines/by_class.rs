//! How many rocks of each class of size and source come to a line.

use super::Line;
use crate::frequency::Frequency;
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

/// Classes that were released and of which nothing comes, neighbours in size of one source as one.
pub fn classes_without_arrival(classes: &[ClassReach]) -> Vec<ClassReach> {
    let is_silent = |class: &ClassReach| class.released > 0 && class.reached == 0;
    let goes_on = |one: &ClassReach, next: &ClassReach| {
        is_silent(one) == is_silent(next) && one.source == next.source
    };
    let whole = |run: &[ClassReach]| {
        let volumes = |class: &ClassReach| class.volume_m3;
        let ends = run.first().and_then(volumes).zip(run.last().and_then(volumes));
        ClassReach {
            source: run[0].source.clone(),
            volume_m3: ends.map(|([low, _], [_, high])| [low, high]),
            per_year: run.iter().map(|class| class.per_year).sum(),
            released: run.iter().map(|class| class.released).sum(),
            reached: 0,
        }
    };
    let runs = classes.chunk_by(goes_on);
    runs.filter(|run| is_silent(&run[0])).map(whole).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frequency::{Class, FrequencyLaw, RockSource};
    use crate::hazard::LineInfo;
    use crate::hazard::lines::tests::row;

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
        let silent = classes_without_arrival(&classes);
        let said: Vec<_> =
            silent.iter().map(|one| (one.source.as_str(), one.volume_m3, one.released)).collect();
        assert_eq!(said, [("wall", Some([2.0, 8.0]), 5)]);
        assert_eq!(line.by_class(None), []);
    }
}
