//! What is noted down along one rock's way: largest values, path, impacts, ledger, effort.
//!
//! The recorder follows the motion and never acts on it: with or without paths, lines and maps the
//! rock goes the same way, bit for bit. Everything is in SI units and local coordinates; the writer
//! adds the terrain's offset.

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

/// What to keep of a rock's way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordOptions {
    /// Time between stored path points (s); `None` keeps no path.
    pub path_step_s: Option<f64>,
    /// Whether the impacts are stored one by one.
    pub impacts: bool,
}

/// Notes along the way.
/// `now` is the last instant noted; flights and steps append to it and leave no gap in time.
#[derive(Debug)]
pub(super) struct Recorder<'a> {
    terrain: &'a Terrain,
    geometry: RockGeometry<'a>,
    keep: RecordOptions,
    pub(super) now: Motion,
    /// How a block is turned now; none for a sphere.
    pub(super) rotation: Option<BlockRotation>,
    pub(super) extremes: Extremes,
    pub(super) path: Vec<PathPoint>,
    pub(super) impacts: Impacts,
    pub(super) crossings: Crossings<'a>,
    pub(super) passages: CellPassages<'a>,
    stretches: Stretches,
    /// Only spares searches: it is not put back.
    triangle_below: TriangleBelow,
    pub(super) tree_impact_count: u32,
    pub(super) ledger: Ledger,
    pub(super) effort: Effort,
    /// When the path gets its next point (s); infinite where none is kept.
    next_point_s: f64,
}

/// A moment of a journey, to go back to: lists only grow, so their lengths will do.
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

/// Difference of two times that is rounding of their sums (–).
const CLOCK_ROUNDING: f64 = 1e-9;

impl<'a> Recorder<'a> {
    pub(super) fn new(
        terrain: &'a Terrain,
        geometry: RockGeometry<'a>,
        (start, rotation): (Motion, Option<BlockRotation>),
        (keep, recorders): (RecordOptions, Recorders<'a>),
    ) -> Self {
        let mut recorder = Self {
            terrain,
            geometry,
            keep,
            now: start,
            rotation,
            extremes: Extremes::default(),
            path: Vec::new(),
            impacts: Impacts::new(keep.impacts),
            crossings: Crossings::of(terrain, geometry, recorders.lines, &start.position_m),
            passages: CellPassages::of(recorders.cells),
            stretches: Stretches::of(recorders.profile_step_m, &start),
            triangle_below: TriangleBelow::default(),
            tree_impact_count: 0,
            ledger: Ledger::default(),
            effort: Effort::default(),
            next_point_s: if keep.path_step_s.is_some() { 0.0 } else { f64::INFINITY },
        };
        // the release itself counts: a rock thrown at 20 m/s has had 20 m/s, whatever comes
        recorder.note_speed();
        let height_m = recorder.clearance_m(&recorder.instant()).unwrap_or(0.0);
        recorder.note_height(&start.position_m, height_m);
        let (at, speed_m_s) = (start.position_m, start.velocity_m_s.norm());
        recorder.stretches.note(&at, speed_m_s, recorder.extremes.height_m);
        recorder
    }

    /// The present.
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

    /// Goes back to `mark`; what was tried in vain was work all the same.
    /// `effort` is not put back.
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

    /// Notes the present speed and energies.
    ///
    /// Called at both ends of every flight and step: speed and energy along a parabola are largest
    /// at an end, and contact steps are short.
    fn note_speed(&mut self) {
        let translational_j = self.now.translational_j(&self.geometry.rock);
        let rotational_j = self.geometry.rotational_j(&self.instant());
        let extremes = &mut self.extremes;
        extremes.speed_m_s = extremes.speed_m_s.max(self.now.velocity_m_s.norm());
        extremes.translational_j = extremes.translational_j.max(translational_j);
        extremes.rotational_j = extremes.rotational_j.max(rotational_j);
        extremes.total_j = extremes.total_j.max(translational_j + rotational_j);
    }

    /// Goes on from a blow that took no time: the largest speed may be the one right after it.
    pub(super) fn note_velocity_jump(&mut self, motion: Motion) {
        self.now = motion;
        self.note_speed();
    }

    /// Motion and turn as of now.
    fn instant(&self) -> RockInstant {
        RockInstant { motion: self.now, rotation: self.rotation }
    }

    /// Vertical distance from the ground below to the lowest point of the rock (m), negative when
    /// pressed in; none beside the terrain.
    fn clearance_m(&self, at: &RockInstant) -> Option<f64> {
        let centre = &at.motion.position_m;
        self.terrain
            .ground_under(centre.x, centre.y, centre.z)
            .map(|ground| centre.z - self.geometry.depth_below_centre_m(at) - ground)
    }

    /// Notes a height over the ground (m) and where the rock has it.
    fn note_height(&mut self, at: &Vec3, height_m: f64) {
        if height_m > self.extremes.height_m {
            self.extremes.height_m = height_m;
            self.stretches.note(at, 0.0, height_m);
        }
    }

    /// Goes along a flight for `dt` (s); a block turns as `top` does.
    pub(super) fn record_flight(&mut self, path: &Parabola, top: Option<&Top>, dt: f64) {
        let turning = top.map(AttitudePath::Top);
        let flight = RockFlight { start: self.now, path, turning, lasts_s: dt };
        // path points at even times, on the parabola itself
        while self.next_point_s <= flight.start.time_s + dt {
            let instant = flight.at(self.next_point_s - flight.start.time_s);
            let motion = Motion { time_s: self.next_point_s, ..instant.motion };
            self.push_path_point(&RockInstant { motion, ..instant }, PathState::Flight);
        }
        // lines, cells and stretches each look at the flight as a whole, not at its points
        self.crossings.fly(&flight);
        self.note_heights(&flight);
        let end = flight.at(dt);
        // the end is computed as the parabola gives it, so that the touch found there holds to the
        // last digit
        (self.now, self.rotation) = (end.motion, end.rotation);
        self.note_speed();
    }

    /// Notes the heights along a flight, the cells and the stretches below it.
    fn note_heights(&mut self, flight: &RockFlight) {
        let geometry = self.geometry;
        let heights = Heights { terrain: self.terrain, geometry: &geometry, flight };
        self.note_largest_height(&heights);
        self.passages.fly(&heights);
        self.stretches.fly(&heights);
    }

    /// Notes the largest height on a way.
    fn note_largest_height(&mut self, heights: &Heights) {
        let flight = heights.flight;
        if let Some(top) = heights.largest([0.0, flight.lasts_s], self.extremes.height_m) {
            self.note_height(&flight.path.centre(top.time_s), top.height_m);
        }
    }

    /// Notes how a step goes, by how the rock moves and is turned where it begins and ends. In a world a flying rock is carried along by
    /// the steps of its island, and so is one that hangs on others or lies on them: between the ends it may be higher than at both.
    ///
    /// Energies are those of the ends' velocities: a blow in a step that is hardly any moves a rock by more than its velocity says.
    fn note_step(&mut self, ends @ [from, to]: [&RockInstant; 2], is_off_ground: bool) {
        let (terrain, geometry) = (self.terrain, self.geometry);
        let lasts_s = to.motion.time_s - from.motion.time_s;
        let path = Parabola::between(&from.motion, &to.motion, geometry.plan_radius_m());
        let turns = from.rotation.as_ref().zip(to.rotation.as_ref());
        let turning = turns.map(|(from, to)| AttitudePath::Step([from, to]));
        let flight = RockFlight { start: from.motion, path: &path, turning, lasts_s };
        let heights = Heights { terrain, geometry: &geometry, flight: &flight };
        let heights = Some(heights).filter(|_| lasts_s > 0.0);
        let are_heights_needed = self.passages.are_recorded() || self.stretches.are_recorded();
        let height_bound_m = match (are_heights_needed, is_off_ground) {
            (false, _) => 0.0,
            (true, true) => f64::INFINITY,
            (true, false) => self.triangle_below.height_bound_m((terrain, &geometry), ends),
        };
        let at_step = StepHeights { heights, height_bound_m };
        self.passages.step((terrain, &geometry), ends, &at_step);
        self.stretches.step(ends.map(|end| &end.motion), &at_step);
        if let Some(heights) = heights {
            self.note_largest_height(&heights);
        }
    }

    /// Goes along one step in contact to `to`.
    pub(super) fn record_step(&mut self, to: impl Into<RockInstant>, slides: bool) {
        self.record_step_as(to, PathState::in_contact(slides), false);
    }

    /// Stays where it is until `now_s` (s): one step at rest, in which the speed with which a rock fell asleep takes it nowhere.
    pub(super) fn record_rest_until(&mut self, now_s: f64) {
        let before = self.now;
        let still = Vec3::zeros();
        self.now = Motion { velocity_m_s: still, spin_rad_s: still, ..before };
        self.record_step_as(Motion { time_s: now_s, ..self.now }, PathState::Sticking, false);
        self.now = Motion { time_s: now_s, ..before };
    }

    /// Goes along one step in `state` to `to`; off the ground a rock has a height above it, also one that others hold.
    pub(super) fn record_step_as(
        &mut self,
        to: impl Into<RockInstant>,
        state: PathState,
        is_off_ground: bool,
    ) {
        let (from, to) = (self.instant(), to.into());
        (self.now, self.rotation) = (to.motion, to.rotation);
        // a step in contact is noted from where it began to where it ended
        self.crossings.step([&from, &to]);
        let (from_s, to_s) = (from.motion.time_s, to.motion.time_s);
        let lasts_s = to_s - from_s;
        while self.next_point_s <= to_s {
            let s = if lasts_s > 0.0 { (self.next_point_s - from_s) / lasts_s } else { 1.0 };
            let mut at = RockInstant::interpolated([&from, &to], s.clamp(0.0, 1.0));
            at.motion.time_s = self.next_point_s;
            self.push_path_point(&at, state);
        }
        self.note_step([&from, &to], is_off_ground);
        self.note_speed();
    }

    fn push_path_point(&mut self, at: &RockInstant, state: PathState) {
        let clearance_m = self.clearance_m(at).unwrap_or(f64::NAN);
        let attitude = at.rotation.map(|rotation| rotation.quaternion());
        self.path.push(PathPoint { motion: at.motion, clearance_m, state, attitude });
        self.next_point_s += self.keep.path_step_s.unwrap_or(f64::INFINITY);
    }

    /// The whole journey of a rock of this weight (N) that was released with this energy of motion (J).
    pub(super) fn into_trajectory(
        mut self,
        release: &Release,
        stop: Stop,
        (weight_n, kinetic_j): (f64, f64),
    ) -> Trajectory {
        self.end_path();
        let fallen_m = release.motion.position_m.z - self.now.position_m.z;
        Trajectory {
            // the caller knows number and shape
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
            released_j: weight_n * fallen_m + kinetic_j,
            effort: self.effort,
        }
    }

    /// Keeps the last point of the path.
    /// So that a path ends where its rock does, whatever the time step of its points.
    fn end_path(&mut self) {
        if self.keep.path_step_s.is_some()
            && self.path.last().is_none_or(|last| last.motion.time_s < self.now.time_s)
        {
            let state = self.path.last().map_or(PathState::Flight, |last| last.state);
            let now = self.instant();
            // one that was due as the rock ends, but for rounding of the clock, is this one
            let end_s = now.motion.time_s;
            self.path.pop_if(|last| end_s - last.motion.time_s < CLOCK_ROUNDING * end_s);
            self.push_path_point(&now, state);
        }
    }
}
