use crate::common;
use common::GROUND;
use common::together::{self, World, plane};
use rockfall::ground::Ground;
use rockfall::solver::Scheme;

#[test]
fn pinch() {
    let ground = Ground {
        normal_stiffness_n_m: 1e10,
        shear_stiffness_n_m: 2.5e9,
        restitution: Some(0.4),
        friction_angle_rad: 30f64.to_radians(),
        ..GROUND
    };
    let base = World {
        stiffness_n_m: 1e10,
        restitution: 0.4,
        gravity_m_s2: 9.81,
        friction_angle_rad: 30f64.to_radians(),
        ground,
        ..together::WORLD
    };
    let (rb, rs) = (0.5, 0.29);
    for vs in [0.0, 6.0] {
        for deg in [5.0_f64, 20.0, 35.0, 50.0, 65.0] {
            for touch in [true, false] {
                let a = deg.to_radians();
                let d = rb + rs + 1e-3;
                let v = [0.0, 12.0, -10.7];
                // the stone on the ground; the boulder up and behind
                let lift = if touch { 0.0 } else { 0.003 };
                let stone =
                    (rs, 2700.0, [0.0, 0.0, rs + lift], [0.0, vs, 0.0], [-vs / rs, 0.0, 0.0]);
                let boulder = (
                    rb,
                    2700.0,
                    [0.0, -a.sin() * d, rs + lift + a.cos() * d],
                    v,
                    [-16.0 / rb, 0.0, 0.0],
                );
                if boulder.2[2] < rb {
                    continue;
                }
                let mut out = vec![];
                for (scheme, tolerance_m_s, step_s) in [
                    (Scheme::Reference, 1e-8, 0.01),
                    (Scheme::Adaptive, 0.05, 0.01),
                    (Scheme::Rigid, 0.0, 0.01),
                    (Scheme::Rigid, 0.0, 0.001),
                ] {
                    let world = World { scheme, tolerance_m_s, step_s, ..base };
                    let falls = world.falls(&plane(), &[boulder, stone], 0.012);
                    let e = |k: usize| {
                        let m = falls[k].end;
                        format!(
                            "{:.2} {:.2} w {:.1}",
                            m.velocity_m_s.y, m.velocity_m_s.z, m.spin_rad_s.x
                        )
                    };
                    out.push(format!("[{} | {}]", e(0), e(1)));
                }
                println!(
                    "vs {vs} deg {deg} touch {touch}: ref {} ada {} rig {} rig1 {}",
                    out[0], out[1], out[2], out[3]
                );
            }
        }
    }
}
