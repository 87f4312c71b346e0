//! Conservation over all releases of a scene: none panics, none fails, none is lost through the mesh, none gains energy.

use super::scene_page::setting;
use crate::ensemble::Ensemble;
use crate::error::Result;
use crate::plan::{Part, Plan};
use crate::report::format;
use crate::simulation::{self, Effort, Scratch, Stop, Trajectory};
use crate::terrain::Terrain;
use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// Mechanical energy may rise over a contact by this share of what the rock has (–): the steps refuse more than 1e-10 of
/// it each, and round.
const ALLOWED_RISE: f64 = 1e-9;
/// What the numerics may lose or gain of all the energy released (–): at the default tolerance a slow impact is known to a
/// few per cent, all of them together much better.
const REMAINDER: f64 = 0.01;

/// The largest number found, and whose it is.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Worst {
    value: f64,
    release: usize,
}

impl Worst {
    /// What is no number is the worst of all.
    fn see(&mut self, value: f64, release: usize) {
        let value = if value.is_nan() { f64::INFINITY } else { value };
        if value > self.value {
            *self = Self { value, release };
        }
    }
}

/// Releases of one kind: how many, and the first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct ReleaseCount {
    rocks: usize,
    first: usize,
}

impl ReleaseCount {
    fn add(&mut self, is_one: bool, release: usize) {
        if is_one {
            self.first = if self.rocks == 0 { release } else { self.first };
            self.rocks += 1;
        }
    }
}

/// One bound and what was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Bound {
    /// What is held, in words.
    pub law: &'static str,
    /// The number found.
    pub found: f64,
    /// The largest that holds.
    pub bound: f64,
    /// The release that it was found with; `None` for a sum, or where there is none.
    pub release: Option<usize>,
}

impl Bound {
    /// Whether the bound is kept; what is no number keeps none.
    pub fn holds(&self) -> bool {
        self.found <= self.bound
    }
}

/// What all releases of a scene did.
#[derive(Debug, Clone, Default)]
pub struct Conservation {
    title: String,
    setting: String,
    asked: usize,
    done: usize,
    seconds: f64,
    threads: usize,
    /// Where a panic ended the run: releases from the first to the second number.
    panicked: Option<(usize, usize)>,
    failed: ReleaseCount,
    lost: ReleaseCount,
    infinite: ReleaseCount,
    out_of_time: ReleaseCount,
    left: ReleaseCount,
    rise: Worst,
    rise_j: Worst,
    remainder: Worst,
    released_j: f64,
    remainder_j: f64,
    effort: Effort,
}

/// Runs all releases of a plan; `done` hears how many are.
///
/// # Errors
/// A release that cannot be made.
pub fn study(mut plan: Plan, ensemble: &Ensemble, done: impl Fn(usize)) -> Result<Conservation> {
    plan.paths = Part::LeftOut("this study keeps no paths");
    plan.impacts = Part::LeftOut("this study keeps no impacts");
    plan.lines = Part::LeftOut("this study has no lines");
    plan.maps = Part::LeftOut("this study draws no maps");
    plan.profile = Part::LeftOut("this study draws no profile");
    let mut found = Conservation {
        title: plan.title.clone(),
        setting: format!("{}, {}", plan.step.scheme.name(), setting(&plan.step)),
        asked: plan.count,
        threads: ensemble.threads(),
        ..Conservation::default()
    };
    let fall = |index: usize, scratch: &mut Scratch| {
        simulation::simulate_release(&plan, index, None, scratch)
    };
    let begun = Instant::now();
    let mut chunks = ensemble.in_chunks(0..plan.count, Scratch::default, fall);
    loop {
        // A panic is a bug: it must show as a broken bound, beside what the rocks before it did.
        let Ok(chunk) = catch_unwind(AssertUnwindSafe(|| chunks.next())) else {
            found.panicked = Some((found.done, plan.count));
            break;
        };
        let Some(falls) = chunk else { break };
        falls?.iter().for_each(|fall| found.add(fall, &plan.terrain));
        done(found.done);
    }
    found.seconds = begun.elapsed().as_secs_f64();
    Ok(found)
}

impl Conservation {
    fn add(&mut self, fall: &Trajectory, terrain: &Terrain) {
        let index = fall.index;
        self.done += 1;
        self.failed.add(matches!(fall.stop, Stop::Failed(_)), index);
        self.out_of_time.add(fall.stop == Stop::TimeUp, index);
        self.left.add(fall.stop == Stop::LeftTerrain, index);
        self.lost.add(is_lost(fall, terrain), index);
        self.infinite.add(!is_finite(fall), index);
        let energy = fall.released_j.max(fall.extremes.total_j).max(f64::MIN_POSITIVE);
        self.rise.see(fall.ledger.rise_j / energy, index);
        self.rise_j.see(fall.ledger.rise_j, index);
        self.remainder.see(fall.energy_balance_error(), index);
        self.released_j += fall.released_j;
        self.remainder_j += fall.ledger.remainder_j;
        self.effort.add(&fall.effort);
    }

    /// Every bound with what was found.
    pub fn bounds(&self) -> Vec<Bound> {
        let count = |law, count: &ReleaseCount| Bound {
            law,
            found: count.rocks as f64,
            bound: 0.0,
            release: (count.rocks > 0).then_some(count.first),
        };
        let panicked = Bound {
            law: "panics",
            found: f64::from(u8::from(self.panicked.is_some())),
            bound: 0.0,
            release: self.panicked.map(|(from, _)| from),
        };
        vec![
            panicked,
            count("rocks that failed", &self.failed),
            count("rocks lost: they ended beneath the slope, nothing below them", &self.lost),
            count("rocks whose end is not finite", &self.infinite),
            Bound {
                law: "largest rise of mechanical energy over one contact, over the rock's energy",
                found: self.rise.value,
                bound: ALLOWED_RISE,
                release: (self.rise.value > 0.0).then_some(self.rise.release),
            },
            Bound {
                law: "energy of all rocks not accounted for, over all energy released",
                found: (self.remainder_j / self.released_j).abs(),
                bound: REMAINDER,
                release: None,
            },
        ]
    }

    /// Whether all releases were computed and every bound is kept.
    pub fn holds(&self) -> bool {
        self.done == self.asked && self.bounds().iter().all(Bound::holds)
    }
}

/// Whether a rock ended beneath the slope: some of it above the centre, nothing below.
fn is_lost(fall: &Trajectory, terrain: &Terrain) -> bool {
    let end = &fall.end.position_m;
    terrain.ground_below(end.x, end.y).is_some_and(|height| height > end.z)
        && terrain.ground_under(end.x, end.y, end.z).is_none()
}

fn is_finite(fall: &Trajectory) -> bool {
    let end = &fall.end;
    [end.position_m, end.velocity_m_s, end.spin_rad_s]
        .iter()
        .all(|v| v.iter().all(|x| x.is_finite()))
}

/// Writes the page.
pub(super) fn page(found: &Conservation) -> String {
    let each = |count: u64| format!("{:.0}", count as f64 / found.done.max(1) as f64);
    let mut page = format!("# Conservation: {}\n\n", found.title);
    let _ = writeln!(
        page,
        "{} of {} releases with scheme {}, paths, lines and maps left out: {:.0} s on {} {}, {} contact steps and {} flights a rock. \
         {} left the terrain, {} ran out of time, all others came to rest. A bound that is not kept makes the exit status of \
         `rockfall study stability SCENE` 1; `rockfall run SCENE --only I` shows release I again.\n",
        found.done,
        found.asked,
        found.setting,
        found.seconds,
        found.threads,
        format::counted(found.threads, "thread", "threads"),
        each(found.effort.steps),
        each(found.effort.leaps),
        found.left.rocks,
        found.out_of_time.rocks,
    );
    page += "| what is held | found | bound | kept | release |\n|---|---|---|---|---|\n";
    for bound in found.bounds() {
        let Bound { law, found, bound: most, release } = &bound;
        let kept = if bound.holds() { "yes" } else { "**no**" };
        let release = release.map_or_else(String::new, |index| index.to_string());
        let _ = writeln!(page, "| {law} | {found:.1e} | {most:.1e} | {kept} | {release} |");
    }
    let _ = writeln!(
        page,
        "\nLargest rise of energy over one contact: {:.1e} J (release {}). Not accounted for: {:+.2} % of the energy of all rocks \
         (positive: lost), at most {:.1} % of the energy of one rock (release {}). Contact steps that did not settle: {} of {}.",
        found.rise_j.value,
        found.rise_j.release,
        100.0 * found.remainder_j / found.released_j,
        100.0 * found.remainder.value,
        found.remainder.release,
        found.effort.unsettled,
        found.effort.steps,
    );
    page
}

/// All bounds as CSV.
pub(super) fn csv(found: &Conservation) -> String {
    let mut text = String::from("releases,law,found,bound,holds,release\n");
    for bound in found.bounds() {
        let release = bound.release.map_or_else(String::new, |index| index.to_string());
        let _ = writeln!(
            text,
            "{},\"{}\",{:.3e},{:.3e},{},{release}",
            found.done,
            bound.law,
            bound.found,
            bound.bound,
            bound.holds()
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every bound can be broken: by a count of one, by a rise, by what is no number, by releases never computed.
    #[test]
    fn every_bound_can_be_broken() {
        let good = Conservation { asked: 9, done: 9, released_j: 1.0, ..Conservation::default() };
        assert!(good.holds());
        let one = ReleaseCount { rocks: 1, first: 3 };
        let rise = Worst { value: 2.0 * ALLOWED_RISE, release: 7 };
        let bad = [
            Conservation { failed: one, ..good.clone() },
            Conservation { lost: one, ..good.clone() },
            Conservation { infinite: one, ..good.clone() },
            Conservation { rise, ..good.clone() },
            Conservation { remainder_j: -0.02, ..good.clone() },
            Conservation { remainder_j: f64::NAN, ..good.clone() },
            Conservation { panicked: Some((3, 9)), ..good.clone() },
        ];
        for bad in bad {
            assert_eq!(bad.bounds().iter().filter(|bound| !bound.holds()).count(), 1, "{bad:?}");
            assert!(!bad.holds() && page(&bad).contains("**no**"));
        }
        assert!(!Conservation { done: 8, ..good }.holds());
        let mut worst = Worst::default();
        worst.see(f64::NAN, 5);
        assert_eq!(worst.release, 5);
    }
}
