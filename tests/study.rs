//! The exact cases over every scheme.

use rockfall::step::Scheme;
use rockfall::study::cases::CASES;

#[test]
fn look() {
    let only = std::env::var("ONLY").unwrap_or_default();
    for case in CASES.into_iter().filter(|case| only.is_empty() || only == case.name) {
        let terrain = case.terrain();
        for (scheme, ladder) in [
            (Scheme::Adaptive, [1e-1, 1e-2, 1e-3, 1e-4, 1e-5]),
            (Scheme::Reference, [1e-3, 1e-5, 1e-7, 1e-8, 1e-9]),
            (Scheme::Rigid, [1e-2, 5e-3, 2.5e-3, 1e-3, 1e-4]),
        ] {
            let measures = case.measures(&terrain, scheme);
            print!("{:13} {:10}", case.name, scheme.name());
            for fineness in ladder {
                let run = case.follow(&terrain, &case.settings(scheme, fineness));
                print!(" {:.1e}({})", case.error(&measures, &run), run.effort.steps);
            }
            println!();
            if case.name.starts_with("pivot") {
                println!(
                    "pivot {:?} {:?}",
                    measures.iter().map(|m| m.exact).collect::<Vec<_>>(),
                    case.follow(&terrain, &case.settings(scheme, ladder[3])).end
                );
            }
        }
    }
}
