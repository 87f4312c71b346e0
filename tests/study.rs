//! The exact cases over every scheme.

use rockfall::step::Scheme;
use rockfall::study::cases::CASES;

use rockfall::trajectory::Scratch;

/// Every case with every scheme at a usual setting, within the tolerance that the case itself gives a reason for.
#[test]
fn every_scheme_reaches_every_exact_case() {
    for case in CASES {
        let terrain = case.terrain();
        for (scheme, fineness) in [
            (Scheme::Adaptive, 1e-2),
            (Scheme::Adaptive, 1e-4),
            (Scheme::Reference, 1e-8),
            (Scheme::Rigid, 1e-2),
            (Scheme::Dda, 1e-5),
        ] {
            let step = case.settings(scheme, fineness);
            let journey = case.follow(&terrain, &step, &mut Scratch::default());
            let error = case.error(&case.measures(&terrain, scheme), &journey);
            let (allowed, why) = case.allowed(&step);
            println!("{:13} {:10} {error:.1e} of {allowed:.1e}", case.name, scheme.name());
            assert!(
                error <= allowed,
                "{} {}: {error:e} > {allowed:e} ({why})",
                case.name,
                scheme.name()
            );
        }
    }
}
