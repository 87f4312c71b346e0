use super::*;

/// Turns drawn are uniform: every entry of the matrix has mean 0 and mean square 1/3, within five standard errors.
#[test]
fn turns_are_uniform() {
    let (mut mean, mut square) = (0.0, 0.0);
    let n = 4000;
    for index in 0..n {
        let turn = random_turn(&mut stream(3, Purpose::Shape, index));
        let entry = turn.matrix()[(index % 3, index / 3 % 3)];
        mean += entry / n as f64;
        square += entry * entry / n as f64;
    }
    assert!(mean.abs() < 5.0 / (3.0 * n as f64).sqrt(), "{mean}");
    assert!((square - 1.0 / 3.0).abs() < 5.0 * 0.298 / (n as f64).sqrt(), "{square}");
}
