mod common;
use common::*;
use rockfall::terrain::make;

#[test]
fn try_drop() {
    let t = terrain(make::jittered_plane(4.0, 8, 0.0));
    for tol in [0.1, 0.05, 1e-2, 1e-3, 1e-4] {
        let case = Case { tolerance_m_s: tol, capture_speed_m_s: Some(0.05), ..CASE };
        let f = case.run(&t, [[0.1, 0.2, 1.5], [0.0; 3], [0.0; 3]], 1.0);
        println!(
            "tol {tol}: z {} v {} stop {:?} effort {:?} ledger {:?} rel {}",
            f.end.position_m.z - 0.5 - 0.55883869725074,
            f.end.velocity_m_s.z - 0.20527970628196,
            f.stop,
            f.effort,
            f.ledger,
            f.released_j
        );
    }
    let f = CASE.run(&t, [[0.1, 0.2, 1.5], [0.0; 3], [0.0; 3]], 10.0);
    println!("rest: {:?}", f);
    let f = CASE.run(&t, [[-3.0, 0.2, 0.6], [5.0, 1.0, -5.0], [3.0, -20.0, 4.0]], 0.2);
    println!("oblique: {:?}", f.end);
    let f = CASE.run(&t, [[-3.0, 0.2, 0.5], [5.0, 0.0, -0.0], [0.0, 0.0, 0.0]], 1.0);
    println!("roll: {:?} {:?}", f.end, f.effort);
}
