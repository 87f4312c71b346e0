//! The exact cases over every scheme.

use rockfall::step::Scheme;
use rockfall::study::cases::CASES;

use rockfall::trajectory::Scratch;
use std::fs;
use std::process::Command;

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

/// The stiff and extreme cases: every scheme keeps every bound, each of which has its reason where it is set.
#[test]
fn stiff_and_extreme_cases_keep_their_bounds() {
    let outcomes = rockfall::study::stability::study(|_| ());
    let broken: Vec<_> = outcomes.iter().filter(|outcome| !outcome.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    // every case with every scheme left something behind
    assert!(outcomes.len() > 500);
}

/// A run that goes on until an interval is narrow asks for the same releases whatever the number of threads, writes the
/// bytes of a run that was asked for them at once, and has nothing left to do when resumed.
#[test]
fn a_run_until_an_interval_is_narrow_is_the_same_everywhere() {
    let dir = tempfile::tempdir().unwrap();
    let run = |out: &str, more: &[&str]| {
        let out = dir.path().join(out);
        let done = Command::new(env!("CARGO_BIN_EXE_rockfall"))
            .args(["run", "examples/quick.toml", "--quiet", "--out"])
            .arg(&out)
            .args(more)
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        fs::read_to_string(out.join("releases.csv")).unwrap()
    };
    let until = ["--releases", "60", "--until", "runout.p50 < 2.5 m"];
    let alone = run("one", &[&until[..], &["--threads", "1"]].concat());
    let rows = alone.lines().count() - 1;
    assert!(rows > 60, "the aim was reached with the first releases: the test tests nothing");
    assert_eq!(alone, run("two", &[&until[..], &["--threads", "2"]].concat()));
    assert_eq!(alone, run("once", &["--releases", &rows.to_string()]));
    assert_eq!(alone, run("one", &[&until[..], &["--resume"]].concat()));
}
