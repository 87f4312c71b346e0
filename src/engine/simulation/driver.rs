//! The loop over flights and contact episodes of one rock alone.
//!
//! Free flight and contact alternate. In flight the centre moves on a parabola. The flight ends at
//! the smallest root at which the centre comes within a radius of the mesh; there are no steps and
//! no air drag. In contact a scheme integrates translation, rotation and springs until no contact
//! is left. A contact episode ends with an energy balance: mechanical energy before and after,
//! losses by cause, and the remainder, which is the numerical error.

use super::Stop;
use super::recorder::Recorder;
use super::rest::RestCriterion;
use super::rock_geometry::RockInstant;
use super::settings::RunSettings;
use crate::rock::Vec3;
use crate::solver::loss::Loss;
use crate::solver::step_control::{Advance, StepError};

/// One rock, sphere or block, as the driver sees it.
pub(super) trait RockSimulation<'a> {
    /// State of the scheme that lasts for one contact episode.
    type StepperState;

    fn settings(&self) -> &'a RunSettings<'a>;

    fn recorder(&mut self) -> &mut Recorder<'a>;

    /// Centre (m) and radius (m) of the bounding sphere. At rest the rim of this sphere must be
    /// slow too.
    fn bounding_sphere(&self) -> (Vec3, f64);

    /// Mechanical energy (J), gravity included: `m v²/2 + ω·L/2 − m g·c`; without elastic energy.
    fn mechanical_energy_j(&self) -> f64;

    /// Flies to the next contact; `None` if there is one, else why the rock stops.
    fn fly(&mut self) -> Option<Stop>;

    /// Begins a contact episode; also returns the elastic energy that the contacts hold already
    /// (J).
    fn begin_contact(&mut self) -> (Self::StepperState, Loss);

    /// Resolves the impacts that are due before a step. Returns whether they have thrown the rock
    /// off.
    fn resolve_impacts(&mut self) -> bool;

    /// Prepares a step. Returns the longest step (s) before roughness, soil, slip or stems change
    /// the law.
    fn prepare_step(&mut self) -> f64;

    /// One step of at most `longest_s` (s), with its effects on soil and stems; also returns
    /// whether a contact slides.
    ///
    /// # Errors
    /// [`StepError`] if no step, however short, converges.
    fn step(
        &mut self,
        stepper: &mut Self::StepperState,
        longest_s: f64,
    ) -> Result<(Advance, bool), StepError>;

    /// State of the rock, labelled with a time (s).
    fn instant(&self, time_s: f64) -> RockInstant;

    /// Records a step to `to` and the impacts that end with it. Returns whether the rock is free of
    /// contacts.
    fn record_step(&mut self, to: RockInstant, slides: bool) -> bool;

    /// Elastic energy of the contacts at the end of an episode (J).
    fn spring_energy(&mut self) -> Loss;

    /// Ends a contact episode.
    fn end_contact(&mut self);
}

/// Simulates a rock until it stops. A rock that `penetrates` the mesh at release begins with a
/// contact episode: the search for the end of a flight finds no contact that exists already.
pub(super) fn run_to_stop<'a>(rock: &mut impl RockSimulation<'a>, penetrates: bool) -> Stop {
    let mut stop = if penetrates { contact_episode(rock) } else { None };
    loop {
        stop = stop.or_else(|| rock.fly()).or_else(|| contact_episode(rock));
        if let Some(stop) = stop {
            return stop;
        }
    }
}

/// Steps in contact until the rock is free again or stops, and closes the energy balance of the
/// episode.
///
/// Contacts are detected anew at the start. Histories of the episode before are gone, because
/// springs relax in a flight of any length.
fn contact_episode<'a>(rock: &mut impl RockSimulation<'a>) -> Option<Stop> {
    // a rock that penetrates at release, or never separated, starts with elastic energy: it is
    // booked as brought into the episode
    let (mut stepper, spring_energy_before) = rock.begin_contact();
    let (before_j, lost_before_j) = (rock.mechanical_energy_j(), rock.recorder().lost_j());
    let stop = contact_steps(rock, &mut stepper);
    // ΔE of motion and gravity; with losses ≥ 0 and relaxed springs at both ends it is −(losses) up
    // to the numerical error, the remainder
    let rise_j = rock.mechanical_energy_j() - before_j;
    let recorder = rock.recorder();
    recorder.ledger.remainder_j -= rise_j + (recorder.lost_j() - lost_before_j);
    let spring_energy = rock.spring_energy();
    rock.recorder().end_episode(rise_j, &spring_energy, &spring_energy_before);
    rock.end_contact();
    stop
}

/// Steps through one contact episode until the rock flies (`None`) or stops.
///
/// Order of each step: changes that the ground makes, the step of the scheme, new impacts, the
/// record. The order matters: impacts are recorded with the speed before their losses are booked.
fn contact_steps<'a, R: RockSimulation<'a>>(
    rock: &mut R,
    stepper: &mut R::StepperState,
) -> Option<Stop> {
    let settings = rock.settings();
    let (centre, radius_m) = rock.bounding_sphere();
    let mut rest_criterion = RestCriterion::new(centre);
    loop {
        if rock.resolve_impacts() {
            return None;
        }
        let from = rock.recorder().now;
        let time_left_s = settings.longest_s - from.time_s;
        let rest_s = rest_criterion.longest_s(&from, radius_m, &settings.rest);
        // the shortest of the time left, the half of the rest rule, and the time until the law
        // changes
        let longest_s = time_left_s.min(rest_s).min(rock.prepare_step());
        let (done, slides) = match rock.step(stepper, longest_s) {
            Ok(done) => done,
            Err(error) => return Some(Stop::Failed(error.to_string())),
        };
        let recorder = rock.recorder();
        recorder.effort.steps += done.steps;
        recorder.effort.rejected += done.rejected;
        recorder.effort.unsettled += u64::from(done.unsettled);
        recorder.book_losses(&done.loss);
        let to = rock.instant(from.time_s + done.dt);
        let is_free = rock.record_step(to, slides);
        let ends = settings.end_of_step(from.time_s, done.dt, &rock.recorder().effort);
        if is_free {
            return ends;
        }
        // rest: slow for long enough, not getting faster and not turning round
        rest_criterion.add_step(done.dt, [&from, &to.motion], radius_m, &settings.rest);
        if rest_criterion.is_at_rest() {
            return Some(Stop::AtRest);
        }
        if ends.is_some() {
            return ends;
        }
    }
}
