//! What is recorded along the trajectory of one rock: largest values, path, impacts, energy
//! balance, cost.
//!
//! The recorder observes the motion and never acts on it: with or without paths, lines and maps the
//! trajectory is the same, bit for bit. All quantities are in SI units and local coordinates; the
//! writer adds the terrain's offset.

mod booking;

use super::cells::{CellPassage, CellPassages};
use super::contact_heights::{StepHeights, TriangleBelow};
use super::crossings::{Crossings, CrossingsMark};
use super::heights::Heights;
use super::impacts::{Impacts, ImpactsMark};
use super::rock_geometry::{AttitudePath, BlockRotation, RockFlight, RockGeometry, RockInstant};
use super::stretches::{Stretch, Stretches};
use super::{Effort, Extremes, Ledger, PathPoint, PathState, Stop, Trajectory};
use crate::flight::Parabola;
use crate::flight::top::Top;
use crate::plan::Recorders;
use crate::release::Release;
use crate::rock::{Motion, Vec3};
use crate::terrain::Terrain;

/// What to record of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordOptions {
    /// Time between stored path points (s); `None` keeps no path.
    pub path_step_s: Option<f64>,
    /// Whether the impacts are stored one by one.
    pub impacts: bool,
}

/// The record of one rock so far. `now` is the last recorded instant; flights and steps are
/// appended to it without gaps in time.
#[derive(Debug)]
pub(super) struct Recorder<'a> {
    terrain: &'a Terrain,
    geometry: RockGeometry<'a>,
    options: RecordOptions,
    pub(super) now: Motion,
    /// Present attitude and rotational energy of a block; none for a sphere.
    pub(super) rotation: Option<BlockRotation>,
    pub(super) extremes: Extremes,
    pub(super) path: Vec<PathPoint>,
    pub(super) impacts: Impacts,
    pub(super) crossings: Crossings<'a>,
    pub(super) passages: CellPassages<'a>,
    stretches: Stretches,
    /// A cache that only saves searches: it is not restored.
    triangle_below: TriangleBelow,
    pub(super) tree_impact_count: u32,
    pub(super) ledger: Ledger,
    pub(super) effort: Effort,
    /// Time of the next path point (s); infinite where no path is kept.
    next_point_s: f64,
}

/// State of a recorder at an instant, to restore. Lists only grow, so their lengths suffice.
#[derive(Debug)]
pub(super) struct RecorderMark {
    now: Motion,
    rotation: Option<BlockRotation>,
    extremes: Extremes,
    path: usize,
    impacts: ImpactsMark,
    crossings: CrossingsMark,
    passages: (usize, Option<CellPassage>),
    stretches: (usize, Option<Stretch>),
    tree_impact_count: u32,
    ledger: Ledger,
    next_point_s: f64,
}

/// Relative difference of two times that is rounding of their sums (–).
const CLOCK_ROUNDING: f64 = 1e-9;

impl<'a> Recorder<'a> {
    pub(super) fn new(
        terrain: &'a Terrain,
        geometry: RockGeometry<'a>,
        (start, rotation): (Motion, Option<BlockRotation>),
        (options, recorders): (RecordOptions, Recorders<'a>),
    ) -> Self {
        let mut recorder = Self {
            terrain,
            geometry,
            options,
            now: start,
            rotation,
            extremes: Extremes::default(),
            path: Vec::new(),
            impacts: Impacts::new(options.impacts),
            crossings: Crossings::of(terrain, geometry, recorders.lines, &start.position_m),
            passages: CellPassages::of(recorders.cells),
            stretches: Stretches::of(recorders.profile_step_m, &start),
            triangle_below: TriangleBelow::default(),
            tree_impact_count: 0,
            ledger: Ledger::default(),
            effort: Effort::default(),
            next_point_s: if options.path_step_s.is_some() { 0.0 } else { f64::INFINITY },
        };
        // the release itself counts: a rock thrown at 20 m/s has had 20 m/s, whatever follows
        recorder.update_extremes();
        let height_m = recorder.clearance_m(&recorder.instant()).unwrap_or(0.0);
        recorder.update_largest_height(&start.position_m, height_m);
        let (at, speed_m_s) = (start.position_m, start.velocity_m_s.norm());
        recorder.stretches.record(&at, speed_m_s, recorder.extremes.height_m);
        recorder
    }

    /// The present state, to restore later.
    pub(super) fn mark(&self) -> RecorderMark {
        RecorderMark {
            now: self.now,
            rotation: self.rotation,
            extremes: self.extremes,
            path: self.path.len(),
            impacts: self.impacts.mark(),
            crossings: self.crossings.mark(),
            passages: self.passages.found.mark(),
            stretches: self.stretches.found.mark(),
            tree_impact_count: self.tree_impact_count,
            ledger: self.ledger,
            next_point_s: self.next_point_s,
        }
    }

    /// Restores `mark`. `effort` is not restored: a computation that is discarded was work all the
    /// same.
    pub(super) fn restore(&mut self, mark: &RecorderMark) {
        (self.now, self.extremes, self.ledger) = (mark.now, mark.extremes, mark.ledger);
        self.rotation = mark.rotation;
        self.path.truncate(mark.path);
        self.impacts.restore(&mark.impacts);
        self.crossings.restore(&mark.crossings);
        self.passages.found.restore(mark.passages);
        self.stretches.found.restore(mark.stretches);
        (self.tree_impact_count, self.next_point_s) = (mark.tree_impact_count, mark.next_point_s);
    }

    /// Updates the largest speed and energies with the present ones.
    ///
    /// Called at both ends of every flight and step: speed and energy along a parabola are largest
    /// at an end, and contact steps are short.
    fn update_extremes(&mut self) {
        let translational_j = self.now.translational_j(&self.geometry.rock);
        let rotational_j = self.geometry.rotational_j(&self.instant());
        let extremes = &mut self.extremes;
        extremes.speed_m_s = extremes.speed_m_s.max(self.now.velocity_m_s.norm());
        extremes.translational_j = extremes.translational_j.max(translational_j);
        extremes.rotational_j = extremes.rotational_j.max(rotational_j);
        extremes.total_j = extremes.total_j.max(translational_j + rotational_j);
    }

    /// Continues with the motion after an instantaneous impact: the speed right after it may be the
    /// largest.
    pub(super) fn record_velocity_jump(&mut self, motion: Motion) {
        self.now = motion;
        self.update_extremes();
    }

    /// Present motion and attitude.
    fn instant(&self) -> RockInstant {
        RockInstant { motion: self.now, rotation: self.rotation }
    }

    /// Vertical distance from the ground below to the lowest point of the rock (m), negative at
    /// penetration; none beside the terrain.
    fn clearance_m(&self, at: &RockInstant) -> Option<f64> {
        let centre = &at.motion.position_m;
        self.terrain
            .ground_under(centre.x, centre.y, centre.z)
            .map(|ground| centre.z - self.geometry.depth_below_centre_m(at) - ground)
    }

    /// Updates the largest height with a height over the ground (m) and the position of the rock
    /// there.
    fn update_largest_height(&mut self, at: &Vec3, height_m: f64) {
        if height_m > self.extremes.height_m {
            self.extremes.height_m = height_m;
            self.stretches.record(at, 0.0, height_m);
        }
    }

    /// Records a flight of `dt` (s); a block rotates as given by `top`.
    pub(super) fn record_flight(&mut self, path: &Parabola, top: Option<&Top>, dt: f64) {
        let attitude_path = top.map(AttitudePath::Top);
        let flight = RockFlight { start: self.now, path, attitude_path, duration_s: dt };
        // path points at regular times, on the parabola itself
        while self.next_point_s <= flight.start.time_s + dt {
            let instant = flight.at(self.next_point_s - flight.start.time_s);
            let motion = Motion { time_s: self.next_point_s, ..instant.motion };
            self.push_path_point(&RockInstant { motion, ..instant }, PathState::Flight);
        }
        // lines, cells and stretches evaluate the flight as a whole, not its points
        self.crossings.record_flight(&flight);
        self.record_flight_heights(&flight);
        let end = flight.at(dt);
        // the end is evaluated on the parabola, so that the contact found there holds to the last
        // digit
        (self.now, self.rotation) = (end.motion, end.rotation);
        self.update_extremes();
    }

    /// Records the heights along a flight, and the cells and stretches below it.
    fn record_flight_heights(&mut self, flight: &RockFlight) {
        let geometry = self.geometry;
        let heights = Heights { terrain: self.terrain, geometry: &geometry, flight };
        self.find_largest_height(&heights);
        self.passages.record_flight(&heights);
        self.stretches.record_flight(&heights);
    }

    /// Updates the largest height with that along a flight or a step.
    fn find_largest_height(&mut self, heights: &Heights) {
        let flight = heights.flight;
        if let Some(top) = heights.largest([0.0, flight.duration_s], self.extremes.height_m) {
            self.update_largest_height(&flight.path.centre(top.time_s), top.height_m);
        }
    }

    /// Records heights, cells and stretches of a step, given the motion and attitude at both ends.
    /// In a world a flying rock is moved by the steps of its island, and so is one that hangs on
    /// others or lies on them: between the ends it may be higher than at both.
    ///
    /// Energies are those of the velocities at the ends: an impact within a very short step moves a
    /// rock by more than its velocity says.
    fn record_step_heights(&mut self, ends @ [from, to]: [&RockInstant; 2], is_off_ground: bool) {
        let (terrain, geometry) = (self.terrain, self.geometry);
        let duration_s = to.motion.time_s - from.motion.time_s;
        let path = Parabola::between(&from.motion, &to.motion, geometry.plan_radius_m());
        let rotations = from.rotation.as_ref().zip(to.rotation.as_ref());
        let attitude_path = rotations.map(|(from, to)| AttitudePath::Step([from, to]));
        let flight = RockFlight { start: from.motion, path: &path, attitude_path, duration_s };
        let heights = Heights { terrain, geometry: &geometry, flight: &flight };
        let heights = Some(heights).filter(|_| duration_s > 0.0);
        let are_heights_needed = self.passages.are_recorded() || self.stretches.are_recorded();
        let height_bound_m = match (are_heights_needed, is_off_ground) {
            (false, _) => 0.0,
            (true, true) => f64::INFINITY,
            (true, false) => self.triangle_below.height_bound_m((terrain, &geometry), ends),
        };
        let at_step = StepHeights { heights, height_bound_m };
        self.passages.record_step((terrain, &geometry), ends, &at_step);
        self.stretches.record_step(ends.map(|end| &end.motion), &at_step);
        if let Some(heights) = heights {
            self.find_largest_height(&heights);
        }
    }

    /// Records one step in contact to `to`.
    pub(super) fn record_step(&mut self, to: impl Into<RockInstant>, slides: bool) {
        self.record_step_as(to, PathState::in_contact(slides), false);
    }

    /// Records rest until `now_s` (s) as one step of zero velocity: the small velocity with which a
    /// rock fell asleep moves it nowhere.
    pub(super) fn record_rest_until(&mut self, now_s: f64) {
        let before = self.now;
        let still = Vec3::zeros();
        self.now = Motion { velocity_m_s: still, spin_rad_s: still, ..before };
        self.record_step_as(Motion { time_s: now_s, ..self.now }, PathState::Sticking, false);
        self.now = Motion { time_s: now_s, ..before };
    }

    /// Records one step in `state` to `to`. A rock off the ground has a height above it, also one
    /// that is held by others.
    pub(super) fn record_step_as(
        &mut self,
        to: impl Into<RockInstant>,
        state: PathState,
        is_off_ground: bool,
    ) {
        let (from, to) = (self.instant(), to.into());
        (self.now, self.rotation) = (to.motion, to.rotation);
        // a step in contact is recorded from its start to its end
        self.crossings.record_step([&from, &to]);
        let (from_s, to_s) = (from.motion.time_s, to.motion.time_s);
        let duration_s = to_s - from_s;
        while self.next_point_s <= to_s {
            let s = if duration_s > 0.0 { (self.next_point_s - from_s) / duration_s } else { 1.0 };
            let mut at = RockInstant::interpolated([&from, &to], s.clamp(0.0, 1.0));
            at.motion.time_s = self.next_point_s;
            self.push_path_point(&at, state);
        }
        self.record_step_heights([&from, &to], is_off_ground);
        self.update_extremes();
    }

    fn push_path_point(&mut self, at: &RockInstant, state: PathState) {
        let clearance_m = self.clearance_m(at).unwrap_or(f64::NAN);
        let attitude = at.rotation.map(|rotation| rotation.quaternion());
        self.path.push(PathPoint { motion: at.motion, clearance_m, state, attitude });
        self.next_point_s += self.options.path_step_s.unwrap_or(f64::INFINITY);
    }

    /// The complete trajectory of a rock of this weight (N) that was released with this kinetic
    /// energy (J).
    pub(super) fn into_trajectory(
        mut self,
        release: &Release,
        stop: Stop,
        (weight_n, kinetic_j): (f64, f64),
    ) -> Trajectory {
        self.end_path();
        let drop_m = release.motion.position_m.z - self.now.position_m.z;
        Trajectory {
            // the caller fills in number and shape
            index: 0,
            rock: release.rock,
            shape: None,
            start: release.motion,
            end: self.now,
            stop,
            extremes: self.extremes,
            impact_count: self.impacts.count,
            tree_impact_count: self.tree_impact_count,
            impacts: self.impacts.rows,
            path: self.path,
            crossings: self.crossings.into_found(),
            passages: self.passages.found.into_found(),
            stretches: self.stretches.found.into_found(),
            ledger: self.ledger.without_gains(),
            released_j: weight_n * drop_m + kinetic_j,
            effort: self.effort,
        }
    }

    /// Adds the last point of the path, so that a path ends where its rock does, whatever the time
    /// step of its points.
    fn end_path(&mut self) {
        if self.options.path_step_s.is_some()
            && self.path.last().is_none_or(|last| last.motion.time_s < self.now.time_s)
        {
            let state = self.path.last().map_or(PathState::Flight, |last| last.state);
            let now = self.instant();
            // a point due at the end, but for rounding of the clock, is replaced by this one
            let end_s = now.motion.time_s;
            self.path.pop_if(|last| end_s - last.motion.time_s < CLOCK_ROUNDING * end_s);
            self.push_path_point(&now, state);
        }
    }
}
