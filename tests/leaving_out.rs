//! Leaving out changes the cost, never the answer.
#![allow(clippy::unwrap_used, reason = "a test that cannot read its scene has failed")]

use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::trajectory::{Scratch, Trajectory, fall};
use std::path::Path;

fn plan(scene: &str) -> Plan {
    let mut scene = Scene::read(Path::new(scene)).unwrap();
    scene.release.count = 40;
    scene.record.paths = Some(0);
    scene.record.impacts = Some(false);
    let (terrain, _) = scene.read_terrain().unwrap();
    Plan::compile(&scene, terrain).unwrap()
}

fn falls(plan: &Plan) -> Vec<Trajectory> {
    let mut scratch = Scratch::default();
    (0..plan.count).map(|index| fall(plan, index, None, &mut scratch).unwrap()).collect()
}

#[test]
fn a_lean_plan_gives_the_same_rocks_as_a_full_one() {
    for scene in ["examples/quick.toml", "examples/tyrol.toml", "examples/paper_slope.toml"] {
        let lean = falls(&plan(scene));
        let full = falls(&plan(scene).keep_everything());
        assert!(lean.iter().all(|rock| rock.path.is_empty() && rock.impacts.is_empty()));
        for (lean, full) in lean.into_iter().zip(full) {
            assert!(!full.path.is_empty() && full.impacts.len() == full.impact_count as usize);
            let bare = Trajectory { path: Vec::new(), impacts: Vec::new(), ..full };
            assert_eq!(lean, bare, "{scene}");
        }
    }
}
