//! State of a rock in contact: motion, contact histories, and the scratch space of its steps.

use super::body::{Body, are_finite};
use super::dda_system::DdaScratch;
pub use super::environment::ContactEnvironment;
use super::friction_rolling::SlipState;
use super::impact_point::Blow;
use super::impact_progress::ImpactProgress;
use super::law::StageContact;
use super::loss::Loss;
use super::plane_state::PlaneState;
use super::roughness::RoughFacets;
use super::stem_load::StemLoad;
use super::tableau::STAGES;
use crate::contact::history::{ContactHistories, MAX_HISTORIES};
use crate::contact::neighbours::Neighbours;
use crate::contact::{ContactPoints, MAX_CONTACTS, TOUCH};
use crate::ground::Law;
use crate::rock::Vec3;
use crate::stopwatch::{Stopwatches, TimedPiece};
use arrayvec::ArrayVec;

/// Rates of change of a rock in contact.
#[derive(Debug, Clone, Copy)]
pub struct StateRates {
    /// Velocity (m/s).
    pub c: Vec3,
    /// Acceleration (m/s²).
    pub v: Vec3,
    /// Angular acceleration (rad/s²).
    pub w: Vec3,
    /// Of the shear springs (m/s), in the frames of the contact histories.
    pub shear: [Vec3; MAX_HISTORIES],
    /// Of the rolling springs (rad/s).
    pub roll: [Vec3; MAX_HISTORIES],
    /// Power lost (W).
    pub loss: Loss,
}

impl StateRates {
    /// Copies rates, those of springs for the first `histories` contacts only.
    #[inline]
    pub fn copy_from(&mut self, from: &Self, histories: usize) {
        (self.c, self.v, self.w, self.loss) = (from.c, from.v, from.w, from.loss);
        self.shear[..histories].copy_from_slice(&from.shear[..histories]);
        self.roll[..histories].copy_from_slice(&from.roll[..histories]);
    }

    /// Sets the rates of the first `histories` springs to zero.
    #[inline]
    pub fn clear(&mut self, histories: usize) {
        self.shear[..histories].fill(Vec3::zeros());
        self.roll[..histories].fill(Vec3::zeros());
    }

    /// No change.
    pub const NONE: Self = Self {
        c: Vec3::new(0.0, 0.0, 0.0),
        v: Vec3::new(0.0, 0.0, 0.0),
        w: Vec3::new(0.0, 0.0, 0.0),
        shear: [Vec3::new(0.0, 0.0, 0.0); MAX_HISTORIES],
        roll: [Vec3::new(0.0, 0.0, 0.0); MAX_HISTORIES],
        loss: Loss::on_slope([0.0; 3]),
    };
}

/// Onsets of impacts within a try of an implicit step: see `step_control::onset`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Onset {
    /// Whether new contacts that may rebound exert no force: the try is cut where they begin.
    pub(super) deferred: bool,
    /// Whether a deferred contact is closed at the end of a stage of this try.
    pub(super) is_reached: bool,
}

/// A rock in contact.
#[derive(Debug)]
pub struct ContactState {
    /// Centre (m, local).
    pub c: Vec3,
    /// Velocity (m/s).
    pub v: Vec3,
    /// Spin (rad/s).
    pub w: Vec3,
    /// Contact histories.
    pub histories: ContactHistories,
    /// Mesh features around it.
    pub near: Neighbours,
    /// Contact points found last.
    pub touches: ContactPoints,
    /// Centre for which they were found, if that was with all slack (m).
    pub(crate) points_found_at: Option<Vec3>,
    /// Rates at the stages of the current step; the first is that at its start.
    pub rates: [StateRates; STAGES],
    /// Whether the first rate belongs to the present state.
    pub fresh: bool,
    /// Energy in the springs of the contacts at the present state (J), if the first rate is fresh.
    pub stored: f64,
    /// Contacts of the current stage.
    pub contacts: [StageContact; MAX_CONTACTS],
    /// Their number.
    pub contact_count: usize,
    /// State and rates of a rock on one plane.
    pub plane: PlaneState,
    /// Progress of an impact that is resolved on its own time scale.
    pub(crate) impact: ImpactProgress,
    /// Contacts of the next impact within an episode (`rigid`).
    pub upcoming_impacts: ContactHistories,
    /// The blows announced last, all of one instant, until they are read.
    pub(crate) blows: ArrayVec<Blow, MAX_CONTACTS>,
    /// Its facets on rough ground.
    pub(crate) facets: RoughFacets,
    /// Energies that it has put into stems.
    pub(crate) stem_load: StemLoad,
    /// Whether a touched stem may break, or several trees are touched: then it is stepped.
    pub may_yield: bool,
    /// Whether the current blow has been announced (`rigid`).
    pub(crate) impact_announced: bool,
    /// Onsets within the present try of an implicit step.
    pub(super) onset: Onset,
    /// Work space of the fixed step.
    pub scratch: DdaScratch,
    /// Number of contact sweeps.
    pub sweeps: u64,
    /// Stopwatches of the run, if it is timed.
    pub stopwatches: Stopwatches,
}

/// Features are collected for centres up to this distance from the present one (–, relative to R) …
pub(super) const MARGIN: f64 = 0.35;
/// … around a point ahead by about half of it (–) …
pub(super) const AHEAD: f64 = 0.17;
/// … at least this far at the start of an impact (–) …
const LEAST_MARGIN: f64 = 0.06;
/// … which lasts about so many contact times `π/ω` (–).
const IMPACT_TRAVEL: f64 = 1.3;
/// Contact points are found up to this distance beyond the radius (–), the range of a stage.
const SLACK: f64 = 0.1;

impl Default for ContactState {
    fn default() -> Self {
        // allocated for the usual number of features before the first rock of a thread
        let near = Neighbours::default();
        Self { near, ..Self::unused() }
    }
}

impl ContactState {
    /// Without allocation: for worlds that keep thousands of rocks.
    pub fn unused() -> Self {
        Self {
            c: Vec3::zeros(),
            v: Vec3::zeros(),
            w: Vec3::zeros(),
            histories: ContactHistories::default(),
            near: Neighbours::empty(),
            touches: ContactPoints::default(),
            points_found_at: None,
            rates: [StateRates::NONE; STAGES],
            fresh: false,
            stored: 0.0,
            contacts: [StageContact::NONE; MAX_CONTACTS],
            contact_count: 0,
            plane: PlaneState::default(),
            impact: ImpactProgress::default(),
            upcoming_impacts: ContactHistories::default(),
            impact_announced: true,
            onset: Onset::default(),
            may_yield: false,
            blows: ArrayVec::new_const(),
            facets: RoughFacets::default(),
            stem_load: StemLoad::default(),
            scratch: DdaScratch::default(),
            sweeps: 0,
            stopwatches: Stopwatches::default(),
        }
    }
}

impl ContactState {
    /// Begins a contact episode of a rock; contacts slower than the capture speed are captured.
    pub fn begin(&mut self, world: &ContactEnvironment, c: Vec3, v: Vec3, w: Vec3) {
        self.begin_within(world, (c, v, w), TOUCH);
    }

    /// Begins an episode with all contact points within `simultaneous` (–, relative to R) touched.
    pub(crate) fn begin_within(
        &mut self,
        world: &ContactEnvironment,
        (c, v, w): (Vec3, Vec3, Vec3),
        simultaneous: f64,
    ) {
        (self.c, self.v, self.w) = (c, v, w);
        self.histories.clear();
        self.fresh = false;
        self.plane.forget();
        self.impact.forget();
        self.upcoming_impacts.clear();
        self.blows.clear();
        (self.impact_announced, self.onset) = (true, Onset::default());
        // the start guess of the previous rock must not influence the result
        self.contacts.iter_mut().for_each(|contact| contact.mode = SlipState::default());
        if !self.near.covers(&c) {
            let margin = self.impact_travel_m(world);
            self.collect_within(world, &c, margin);
        }
        self.find_contact_points(world, &c, world.body.radius * (1.0 + simultaneous));
        self.touches.retain_impacting(world.body.radius, &v, simultaneous);
        // an impact rebounds or not as a whole, by its fastest approach
        let captured = self.touches.iter().all(|touch| world.captures(touch, &v));
        for k in 0..self.touches.len() {
            let touch = &self.touches[k];
            let place = self.histories.find(touch, &self.touches, (1 << k) - 1, || captured);
            if !captured {
                self.impact.add_contact(-touch.normal.dot(&v), world.least_impact_m_s());
                self.inherit_springs(world, place, k);
            }
        }
    }

    /// Makes sure that the features around `c` are collected.
    #[inline]
    pub fn update_neighbours(&mut self, world: &ContactEnvironment, c: &Vec3) {
        if !self.near.covers(c) {
            self.collect(world, c);
        }
    }

    /// Collects the features around `c` and ahead along the velocity, where most are to come.
    pub(crate) fn collect(&mut self, world: &ContactEnvironment, c: &Vec3) {
        let r = world.body.radius;
        self.collect_within(world, &(c + self.v.cap_magnitude(AHEAD * r)), MARGIN * r);
    }

    /// Collects the features for a centre within `margin` (m) of `centre`.
    pub(super) fn collect_within(
        &mut self,
        world: &ContactEnvironment,
        centre: &Vec3,
        margin: f64,
    ) {
        let (r, start) = (world.body.radius, self.stopwatches.now());
        self.near.collect(world.terrain, centre, r, margin, SLACK * r);
        self.stopwatches.stop(TimedPiece::Geometry, start);
    }

    /// Travel during an impact (m), bounded on both sides. A smaller region holds fewer features,
    /// and more often one face alone.
    fn impact_travel_m(&self, world: &ContactEnvironment) -> f64 {
        let slowest = world.laws.iter().map(Law::omega_rad_s).fold(f64::INFINITY, f64::min);
        let way = IMPACT_TRAVEL * std::f64::consts::PI / slowest * self.v.norm();
        way.clamp(LEAST_MARGIN * world.body.radius, MARGIN * world.body.radius)
    }

    /// Finds the contact points at `c` nearer than `reach` (m).
    #[inline]
    pub fn find_contact_points(&mut self, world: &ContactEnvironment, c: &Vec3, reach: f64) {
        self.points_found_at = None;
        let begun = self.stopwatches.now();
        self.collect_contact_points(world, c, reach);
        self.stopwatches.stop(TimedPiece::Geometry, begun);
    }

    /// The same in the midst of something else, without the clock.
    #[inline]
    pub(super) fn collect_contact_points(
        &mut self,
        world: &ContactEnvironment,
        c: &Vec3,
        reach: f64,
    ) {
        self.update_neighbours(world, c);
        self.near.touches(world.terrain, c, reach, &mut self.touches);
    }

    /// Finds the contact points at `c` that a stage must know.
    #[inline]
    pub fn find_contact_points_ahead(&mut self, world: &ContactEnvironment, c: &Vec3) {
        self.find_contact_points(world, c, world.body.radius * (1.0 + SLACK));
    }

    /// Finds them unless those at hand were found at `c`.
    #[inline]
    pub fn update_contact_points_ahead(&mut self, world: &ContactEnvironment, c: &Vec3) {
        if self.points_found_at != Some(*c) {
            self.find_contact_points_ahead(world, c);
            self.points_found_at = Some(*c);
        }
    }

    /// Offset of `c` from where contact points were found; they are found anew beyond `way` (m).
    #[inline]
    pub(super) fn contact_points_ahead_near(
        &mut self,
        world: &ContactEnvironment,
        c: &Vec3,
        way: f64,
    ) -> Vec3 {
        let off = self.points_found_at.map(|at| c - at);
        if let Some(off) = off.filter(|off| off.norm_squared() <= way * way) {
            return off;
        }
        self.update_contact_points_ahead(world, c);
        Vec3::zeros()
    }

    /// History of contact point `k`; a new one starts without stretch and without earlier rates.
    #[inline]
    pub fn history_of(
        &mut self,
        world: &ContactEnvironment,
        k: usize,
        taken: u32,
        v: &Vec3,
    ) -> usize {
        let (before, touch) = (self.histories.len(), &self.touches[k]);
        // a contact that begins during a rebounding impact belongs to it, however slow it is
        let rebounds = self.histories.iter().any(|history| !history.captured);
        let slow = world.captures(touch, v);
        let history = self.histories.find(touch, &self.touches, taken, || slow && !rebounds);
        if history >= before {
            self.histories[history].onset_m_s = if slow { 0.0 } else { -touch.normal.dot(v) };
            self.inherit_springs(world, history, k);
            for rate in &mut self.rates {
                (rate.shear[history], rate.roll[history]) = (Vec3::zeros(), Vec3::zeros());
            }
        }
        history
    }

    /// Contacts of the current stage.
    #[inline]
    pub(super) fn stage_contacts(&self) -> &[StageContact] {
        &self.contacts[..self.contact_count]
    }

    /// Fastest approach among the contacts with force that are new in the present try (m/s).
    pub(super) fn new_contact_approach_m_s(&self) -> f64 {
        let pressed = self.stage_contacts().iter().filter(|contact| contact.normal_force > 0.0);
        pressed.map(|contact| self.histories[contact.history].onset_m_s).fold(0.0, f64::max)
    }

    /// Makes the new contacts of an accepted step part of the impact.
    pub(super) fn accept_new_contacts(&mut self, world: &ContactEnvironment) {
        let slowest = world.least_impact_m_s();
        for history in self.histories.iter_mut() {
            self.impact.add_contact(history.onset_m_s, slowest);
            history.onset_m_s = 0.0;
        }
    }

    /// Lets all contacts not yet announced rebound after all, from an approach of `speed_m_s`.
    pub(crate) fn rebound(&mut self, world: &ContactEnvironment, speed_m_s: f64) {
        for history in self.histories.iter_mut().filter(|history| !history.announced) {
            history.captured = false;
        }
        self.impact.add_contact(speed_m_s, world.least_impact_m_s());
    }

    /// Changes velocity and spin during a contact; the springs keep their stretch.
    pub fn redirect(&mut self, world: &ContactEnvironment, v: Vec3, w: Vec3) {
        self.leave_plane(world);
        (self.v, self.w) = (v, w);
        self.fresh = false;
    }

    /// Largest `√(p_N/m)` among its contacts with the mesh (rad/s), 0 if there is none.
    pub(super) fn stiffest_rad_s(&self, world: &ContactEnvironment) -> f64 {
        let omegas = self.histories.iter().map(|one| world.springs_of(one).omega_rad_s());
        omegas.fold(0.0, f64::max)
    }

    /// Whether no contact is closed.
    pub fn is_free(&self) -> bool {
        self.histories.iter().all(|history| !history.closed)
    }

    /// Whether position, velocity and spin are finite.
    pub(super) fn is_finite(&self) -> bool {
        are_finite([&self.c, &self.v, &self.w])
    }

    /// Kinetic energy (J): `m v²/2 + I w²/2`.
    pub fn motion_j(&self, body: &Body) -> f64 {
        body.motion_j((&self.v, &self.w))
    }
}
