//! One law, three ways to follow it: runout, largest speed and largest energy of the schemes are of one distribution, on smooth
//! and on rough ground.
#![allow(clippy::unwrap_used, reason = "a test that cannot read its scene has failed")]

use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::simulation::{Scratch, Trajectory, simulate_release};
use rockfall::solver::Scheme;
use std::path::Path;

const ROCKS: usize = 600;

fn falls(scheme: Scheme, roughness_deg: f64) -> Vec<Trajectory> {
    let mut scene = Scene::read(Path::new("examples/quick.toml")).unwrap();
    scene.release.count = ROCKS;
    scene.record.paths = Some(0);
    scene.solver.scheme = Some(scheme);
    let rock = scene.grounds.get_mut("rock").unwrap();
    rock.roughness_deg = Some(rockfall::random::Distribution::fixed(roughness_deg).unwrap());
    let (terrain, _) = scene.read_terrain().unwrap();
    let plan = Plan::compile(&scene, terrain).unwrap();
    let mut scratch = Scratch::default();
    (0..ROCKS).map(|index| simulate_release(&plan, index, None, &mut scratch).unwrap()).collect()
}

/// Largest distance of two empirical distributions of equally many values.
fn kolmogorov_smirnov(mut a: Vec<f64>, mut b: Vec<f64>) -> f64 {
    a.sort_by(f64::total_cmp);
    b.sort_by(f64::total_cmp);
    let share = |of: &[f64], x: f64| of.partition_point(|y| *y <= x) as f64 / of.len() as f64;
    a.iter().chain(&b).map(|&x| (share(&a, x) - share(&b, x)).abs()).fold(0.0, f64::max)
}

#[test]
fn runout_speed_and_energy_do_not_depend_on_the_scheme() {
    // p = 0.05: 1.358 √((n + m)/(n m))
    let limit = 1.358 * (2.0 / ROCKS as f64).sqrt();
    for roughness_deg in [0.0, 8.0] {
        let all = [Scheme::Adaptive, Scheme::Rigid, Scheme::Reference]
            .map(|scheme| (scheme, falls(scheme, roughness_deg)));
        for (one, other) in [(0, 1), (0, 2), (1, 2)] {
            let ((name, a), (beside, b)) = (&all[one], &all[other]);
            let apart = |of: fn(&Trajectory) -> f64| {
                kolmogorov_smirnov(a.iter().map(of).collect(), b.iter().map(of).collect())
            };
            let found = [
                apart(Trajectory::runout_m),
                apart(|rock| rock.extremes.speed_m_s),
                apart(|rock| rock.extremes.total_j),
            ];
            println!("{roughness_deg}°: {name:?} and {beside:?} are {found:.4?} apart");
            assert!(found.iter().all(|d| *d < limit), "{name:?} {beside:?} {found:?}");
        }
    }
}
