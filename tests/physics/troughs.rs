//! Spheres that roll on both sides of a trough, which can hold them by friction.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common::{falls, plan_in};
use rockfall::rock::Vec3;
use rockfall::terrain::stl::{Facet, write_binary};

/// A trough along x that falls by 25°, opens by so much (degrees) and is uneven (m): 40 m long, cells of 0.5 m.
fn trough(opening_deg: f64, uneven_m: f64) -> Vec<Facet> {
    let (side, fall) = ((90.0 - 0.5 * opening_deg).to_radians(), 25f64.to_radians());
    let corner = |i: i32, j: i32| {
        let (x, up) = (0.5 * f64::from(i), 0.5 * f64::from(j));
        // heights without a pattern that a rock could follow
        let uneven = (f64::from(i * 127 + j * 311).sin() * 43_758.5).fract();
        let dz = if j == 0 { 0.0 } else { uneven_m * uneven };
        Vec3::new(x, up * side.cos(), dz - x * fall.tan() + up.abs() * side.sin())
    };
    let cell = move |i: i32, j: i32| {
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| corner(i, j));
        [[a, b, c], [a, c, d]]
    };
    (0..80).flat_map(|i| (-8..8).flat_map(move |j| cell(i, j))).collect()
}

/// Mean way (m), and mean largest energy (kJ), of 12 rocks of 0.5 m, or of three in one world, far from each other.
fn rolled(
    scheme: &str,
    stiffness: f64,
    (mesh, rolling_friction): (&[Facet], f64),
    together: bool,
) -> [f64; 2] {
    let dir = tempfile::tempdir().unwrap();
    write_binary(&dir.path().join("trough.stl"), mesh).unwrap();
    let world = if together { "together = true\n" } else { "" };
    let contact = if together {
        "[rocks.contact]\nnormal_stiffness_n_m = 1e9\nshear_stiffness_n_m = 4e8\ntensile_strength_pa = 0.0\ncohesion_pa = 0.0\nfriction_angle_deg = 35.0\nrestitution = 0.4\n"
    } else {
        ""
    };
    let (count, places) =
        if together { (3, "[[2.0, 0.0], [9.0, 0.0], [16.0, 0.0]]") } else { (12, "[[2.0, 0.0]]") };
    let text = format!(
        "title = \"t\"\nseed = 1\n[[terrain]]\nmesh = \"trough.stl\"\nground = \"g\"\n[grounds.g]\n\
         normal_stiffness_n_m = {stiffness:e}\ntangential_ratio = 0.4\nfriction_angle_deg = 35.0\nrestitution = 0.4\n\
         rolling_friction = {rolling_friction}\n[solver]\nscheme = \"{scheme}\"\n[rocks]\ndensity_kg_m3 = 2700.0\nradius_m = 0.5\n\
         {contact}[release]\ncount = {count}\n{world}points_m = {places}\nheight_m = {{ uniform = [0.05, 0.1] }}\n\
         velocity_m_s = [{{ uniform = [1.0, 1.5] }}, 0.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\n"
    );
    let falls = falls(&plan_in(dir.path(), &text));
    let mean =
        |of: &dyn Fn(usize) -> f64| (0..falls.len()).map(of).sum::<f64>() / falls.len() as f64;
    let way = |k: usize| (falls[k].end.position_m - falls[k].start.position_m).xy().norm();
    [mean(&way), mean(&|k| falls[k].extremes.total_j / 1e3)]
}

/// Contacts on both sides keep an error of their forces, as friction across the way holds it, and rolling friction answers to that: with the
/// tolerance of a rock on one plane 12 of 12 stopped after a metre at 60° and 1e11 N/m, where exact steps let all of them leave, and those of
/// 93° had a seventh less energy.
#[test]
fn spheres_roll_on_in_a_trough_as_with_exact_steps() {
    let (narrow, wide) = (trough(60.0, 0.05), trough(93.0, 0.0));
    for (mesh, rolling_friction, stiffness, together) in [
        (&narrow, 0.1, 1e9, false),
        (&narrow, 0.1, 1e11, false),
        (&wide, 0.25, 1e11, false),
        (&narrow, 0.1, 1e9, true),
    ] {
        let of = |scheme| rolled(scheme, stiffness, (mesh, rolling_friction), together);
        let ([way, energy], [exact_way, exact_energy]) = (of("adaptive"), of("reference"));
        println!("{stiffness:e}: {way} {exact_way} m, {energy} {exact_energy} kJ");
        assert!((way / exact_way - 1.0).abs() < 0.01, "{stiffness:e}: {way} {exact_way} m");
        assert!((energy / exact_energy - 1.0).abs() < 0.03, "{energy} {exact_energy} kJ");
    }
}
