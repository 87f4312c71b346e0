//! The method paper's four examples, with its own scheme and step and with the default scheme.
#![allow(clippy::unwrap_used, reason = "a test whose example cannot be planned has failed")]

use rockfall::solver::Scheme;
use rockfall::study::verify::{Example, Verification};

/// Runs an example; every row of its table must hold.
fn verified(example: Example, scheme: Scheme) -> Verification {
    let found = Verification::of(example, scheme).unwrap();
    assert!(found.holds(), "{}", found.table());
    assert!(!found.rows.is_empty());
    found
}

/// The number under a quantity that begins so.
fn number(found: &Verification, quantity: &str) -> f64 {
    let row = found.rows.iter().find(|row| row.quantity.starts_with(quantity));
    row.map_or_else(|| panic!("no row {quantity}"), |row| row.computed)
}

/// Sizes are not printed and were fitted: to 6 % of the printed step.
fn near(found: f64, printed: f64) {
    assert!((found - printed).abs() < 0.06 * printed, "{found} {printed}");
}

#[test]
fn example_1a_settles_in_the_left_valley() {
    let found = verified(Example::AsymmetricEdge, Scheme::Dda);
    near(number(&found, "comes to rest at step"), 1_230_000.0);
    for found in [found, verified(Example::AsymmetricEdge, Scheme::Adaptive)] {
        assert!(number(&found, "place across the edge") < -0.4);
    }
}

#[test]
fn example_1b_balances_on_the_edge() {
    for scheme in [Scheme::Dda, Scheme::Adaptive] {
        let found = verified(Example::SymmetricEdge, scheme);
        near(number(&found, "comes to rest at step"), 109_881.0);
        assert!(number(&found, "stays above the edge").abs() < 1e-12);
    }
}

#[test]
fn example_2_rests_on_the_apex_and_leaves_it() {
    for scheme in [Scheme::Dda, Scheme::Adaptive] {
        let found = verified(Example::Tetrahedron, scheme);
        near(number(&found, "comes to rest at step"), 107_004.0);
        near(number(&found, "begins to fall at step"), 151_004.0);
        assert!(number(&found, "without asymmetry stays").abs() < 1e-6);
    }
}

/// The default scheme; the paper's fixed step of 1e-5 s has a test of its own, it takes ten times as long.
#[test]
fn example_3_fills_both_containers() {
    let found = verified(Example::Containers, Scheme::Adaptive);
    assert!((number(&found, "spheres at rest") - 48.0).abs() < 0.5);
    assert!((number(&found, "spheres on the left") - 24.0).abs() <= 4.0);
}

#[test]
fn example_3_fills_both_containers_as_printed() {
    let found = verified(Example::Containers, Scheme::Dda);
    assert!((number(&found, "spheres at rest") - 48.0).abs() < 0.5);
    assert!((number(&found, "spheres on the left") - 24.0).abs() <= 4.0);
}

#[test]
fn example_4_all_ten_rocks_arrive() {
    for scheme in [Scheme::Dda, Scheme::Adaptive] {
        let found = verified(Example::Rockfall, scheme);
        assert!((number(&found, "rocks at rest or past the foot") - 10.0).abs() < 0.5);
    }
}
