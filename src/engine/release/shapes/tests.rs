use super::*;

/// Drawn rotations are uniform: every entry of the matrix has mean 0 and mean square 1/3, within
/// five standard errors.
#[test]
fn turns_are_uniform() {
    let (mut mean, mut square) = (0.0, 0.0);
    let n = 4000;
    for index in 0..n {
        let turn = random_attitude(&mut stream(3, Purpose::Shape, index));
        let entry = turn.matrix()[(index % 3, index / 3 % 3)];
        mean += entry / n as f64;
        square += entry * entry / n as f64;
    }
    assert!(mean.abs() < 5.0 / (3.0 * n as f64).sqrt(), "{mean}");
    assert!((square - 1.0 / 3.0).abs() < 5.0 * 0.298 / (n as f64).sqrt(), "{square}");
}

/// Drawn sides are tested in all combinations of their ends: with corners of 0.3 a cube and a bar
/// have a core left, a slab has none, and it must not be treated as a sphere.
#[test]
fn sides_are_tried_with_each_others_ends() {
    let table = |axes: &str, ball: f64| -> ShapeTable {
        toml::from_str(&format!("kind = \"box\"\naxes = {axes}\ncorner_radius = {ball}")).unwrap()
    };
    let both = "[{ uniform = [0.1, 1.0] }, { uniform = [0.1, 1.0] }, 1.0]";
    assert_eq!(made_shape(&table(both, 0.3)).err(), Some(BadSurface::NoCore));
    let rare = "[1.0, 1.0, { values = [0.1, 1.0], weights = [1, 5000] }]";
    assert_eq!(made_shape(&table(rare, 0.3)).err(), Some(BadSurface::NoCore));
    let fits = table(both, 0.15);
    let (shape, _) = made_shape(&fits).unwrap();
    let entry = ShapeShare { table: fits, made: shape };
    for first in [0.0, 0.3, 0.999] {
        assert!(
            [0.0, 0.5, 0.999].iter().all(|&other| entry.shape([first, other, 0.5, 0.5]).is_some())
        );
    }
}
