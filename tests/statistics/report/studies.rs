//! The plain figures of verification and studies keep their texts apart, too.

use super::{boxes, svg};
use rockfall::report::curves::Curves;

/// Two series with a title that asks, and spheres over a ground: the forms that the verification draws.
#[test]
fn plain_curves_stay_on_their_paper_and_off_each_other() {
    let title =
        "Example 1a: how does a sphere beside an edge come to rest? Speed (the paper’s Fig. 9a)";
    let wave = |k: u32| (1e4 * f64::from(k), (0.1 * f64::from(k)).sin().abs() * 3.0);
    let mut speeds = Curves::new(title, "Step of 10 µs", "Vertical displacement (m)");
    speeds.lines.push((0..120).map(wave).collect());
    speeds.others.push((0..60).map(wave).collect());
    speeds.names = Some(["dda, 1e-5 s", "adaptive"]);
    let mut side = Curves::new(title, "Across (m)", "Height (m)");
    side.ground.push(vec![(-2.0, 0.0), (2.0, 0.0)]);
    side.discs.extend((0..12).map(|k| (0.1 * f64::from(k), 0.8, 0.05)));
    for (name, curves) in [("speeds", speeds), ("side", side)] {
        let drawn = curves.draw(name);
        svg::check(&drawn, name);
        let faults = boxes::faults(&drawn, name);
        assert!(faults.is_empty(), "{}", faults.join("\n"));
        assert!(svg::strip_tags(&drawn).matches(title).count() == 2, "said aloud and drawn");
    }
}
