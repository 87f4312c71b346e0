use super::*;
use crate::frequency::{Class, Frequency, FrequencyLaw, RockSource};

/// Half of the twenty rocks of each of three strata cross a line. The variance of a share seen to be `p` among `n` is `p (1 − p)/(n − 1)`, without bias, and
/// strata add up by the squares of their events a year.
#[test]
fn the_variance_of_strata_is_without_bias() {
    let per_year = [1.0, 0.4, 0.05];
    let class = |per_year: f64| Class { volume_m3: [1.0; 2], per_year };
    let law = FrequencyLaw::Classes(per_year.map(class).to_vec());
    let source = RockSource { name: "wall".to_owned(), law };
    let weights = Frequency::new(vec![source], vec![], vec![]).weights(60);
    let mut running = Running::new(&weights);
    (0..3).for_each(|stratum| running.add(stratum, &Sums::many(10)));
    let exact = per_year.map(|rate| rate * rate * 0.25 / 19.0).iter().sum::<f64>();
    assert!((running.variance / exact - 1.0).abs() < 1e-12, "{} {exact}", running.variance);
    assert!((running.value - 0.5 * 1.45).abs() < 1e-12, "{}", running.value);
}
