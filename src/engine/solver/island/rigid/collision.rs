//! One blow of several rocks: all that touch each other at its instant take part, and so does the mesh that they touch.
//!
//! In the limit springs are pressed for no time. Those of a scene are pressed for some tenths of a millisecond, in which what is struck goes some
//! millimetres: gaps that close meanwhile are followed as open contacts of the blow, for what a boulder that rides over a stone is thrown up with hangs on
//! them, and the limit would be on the unsafe side.
//!
//! A ball that falls on one that lies on the ground is answered by the ground, and a blow on a row of rocks in touch runs through it:
//! taken pair by pair that would be another law than that of springs. In islands of more rocks than one impact is followed with, in
//! heaps, small blows are taken pair by pair: each of them would run through all that lie there. A rock that strikes hard does so through
//! the nearest that touch, as many as one impact is followed with: what it throws up hangs on that. And a boulder that falls on a
//! stone is answered by the ground below it there too.

use super::RigidIsland;
use super::blow_start::{BlowStart, WIDEST};
use super::broken_stems::TakenByTree;
use super::contacts::{ImpactScene, REBOUNDS_IN_STEP, hit_of};
use crate::contact::ContactPoint;
use crate::contact::pair::normal_and_distance;
use crate::rock::Vec3;
use crate::solver::body::Twist;
use crate::solver::impact::{
    BODIES, CONTACTS, ContactEnds, FrozenBody, FrozenCollision, FrozenContact, frozen_collision,
};
use crate::solver::island::body::IslandBody;
use crate::solver::joint_blow::Breakage;
use crate::solver::law::capture_m_s;
use crate::solver::rigid::HELD;
use arrayvec::ArrayVec;
use nalgebra::Rotation3;

/// Most rocks that a blow is followed with in an island of more than [`BODIES`]: a light one on the mesh, and a heavy one that strikes it.
const TOGETHER_IN_HEAP: usize = 2;
/// By how much the heavy one is heavier (–): taken by itself it would be stopped by blow after blow, and lose nearly all to the light one.
const MUCH_LIGHTER: f64 = 2.0;
/// A rock that is no farther from the mesh at the end of the step (–, relative to R) may have touched it at a blow …
const BESIDE_MESH: f64 = 0.02;
/// … which presses it there if it pushes it against the normal, by this cosine.
const PRESSED_ON: f64 = -0.7;

/// With how many rocks and pairs that touch each other a blow is followed; where there are more, with the nearest of them or not at all.
#[derive(Clone, Copy)]
struct Reach {
    rocks: usize,
    pairs: usize,
    or_nearest: bool,
}

impl Reach {
    const ALL: Self = Self { rocks: BODIES, pairs: CONTACTS, or_nearest: false };
    const ON_MESH: Self = Self { rocks: TOGETHER_IN_HEAP, ..Self::ALL };
    /// One contact of each rock with the mesh must have room too.
    const NEAREST: Self = Self { pairs: CONTACTS - BODIES, or_nearest: true, ..Self::ALL };
}

/// Rocks that touch each other, as places in the island, and their pairs.
#[derive(Default)]
struct TouchingRocks {
    rocks: ArrayVec<usize, BODIES>,
    pairs: ArrayVec<usize, CONTACTS>,
}

impl TouchingRocks {
    /// Adds a pair that is not among them yet, and its rocks; `None` if that is out of reach.
    fn add(&mut self, pair: usize, ends: [u32; 2], reach: Reach) -> Option<()> {
        if self.pairs.contains(&pair) {
            return Some(());
        }
        let new = ends.map(|end| end as usize).into_iter().filter(|end| !self.rocks.contains(end));
        let new: ArrayVec<usize, 2> = new.collect();
        if self.rocks.len() + new.len() > reach.rocks || self.pairs.len() >= reach.pairs {
            return None;
        }
        self.pairs.push(pair);
        self.rocks.extend(new);
        Some(())
    }
}

/// A rock at the instant of a blow.
#[derive(Clone, Copy)]
struct StruckRock {
    c: Vec3,
    v: Vec3,
    /// Whether it touches the mesh.
    on_mesh: bool,
}

/// What came of trying to follow a blow with all whose gaps may close.
enum Followed {
    Yes,
    /// Nor would it be with what touches alone.
    No,
    /// It may be with what touches alone.
    NotSoWide,
}

/// All that takes part in a blow.
struct StruckRocks {
    touching: TouchingRocks,
    /// Every rock that touches.
    rocks: ArrayVec<StruckRock, BODIES>,
}

impl RigidIsland {
    /// Takes a blow `s` (s) before the end of the step together with the rocks that touch, or come to touch while it lasts; whether more take
    /// part than its own ends and not too many.
    pub(super) fn blow_together(
        &mut self,
        scene: &mut ImpactScene,
        blow: &BlowStart,
        s: f64,
    ) -> bool {
        // where no gap closes the blow is that of what touches, to the last digit
        let in_touch = BlowStart { lasts_s: 0.0, ..*blow };
        match self.strike_together(scene, blow, s) {
            Followed::Yes => true,
            Followed::No => false,
            Followed::NotSoWide => {
                matches!(self.strike_together(scene, &in_touch, s), Followed::Yes)
            }
        }
    }

    /// The same with all whose gaps are no wider than may close; not so either if none of them does.
    fn strike_together(&mut self, scene: &mut ImpactScene, blow: &BlowStart, s: f64) -> Followed {
        let Some(reach) = self.reach(scene, blow) else { return Followed::No };
        let Some(touching) = self.touching(scene, blow, (s, reach)) else {
            return Followed::NotSoWide;
        };
        if touching.rocks.len() == 1 {
            return Followed::No;
        }
        let at_blow = |rock: &usize| {
            let (c, v) = self.balls[*rock].before_end(s);
            StruckRock { c, v, on_mesh: false }
        };
        let rocks = touching.rocks.iter().map(at_blow).collect();
        let mut struck = StruckRocks { touching, rocks };
        struck.look(scene, blow);
        let Some(contacts) = self.contacts(scene, &struck, blow) else {
            return Followed::NotSoWide;
        };
        let has_gaps = contacts.iter().any(|contact| contact.gap_m > 0.0);
        if contacts.len() == 1 {
            return Followed::No;
        }
        let thrown = self.thrown(scene, &struck, &contacts, blow);
        let Some(Breakage { after, stems }) = thrown else {
            return if has_gaps { Followed::NotSoWide } else { Followed::No };
        };
        let closes = |(contact, m_s): (&FrozenContact, &f64)| contact.gap_m > 0.0 && *m_s > 0.0;
        if has_gaps && !contacts.iter().zip(&after.fastest_m_s).any(closes) {
            return Followed::NotSoWide;
        }
        let (taken_j, by_trees) = self.book(scene, &struck, &contacts, &after);
        drop(contacts);
        scene.load_stems(&struck.touching.rocks, &by_trees, &stems);
        self.go_on_from(&struck, &after, (taken_j, s));
        Followed::Yes
    }

    /// The motions after a blow, with the stems that it has broken; `None` where it cannot be followed.
    fn thrown(
        &self,
        scene: &ImpactScene,
        StruckRocks { touching, rocks }: &StruckRocks,
        contacts: &[FrozenContact],
        blow: &BlowStart,
    ) -> Option<Breakage> {
        let frozen = |(rock, at): (&usize, &StruckRock)| {
            let ball = &self.balls[*rock];
            FrozenBody { body: ball.body, motion: (at.v, ball.w) }
        };
        let mut bodies: ArrayVec<_, BODIES> =
            touching.rocks.iter().zip(rocks).map(frozen).collect();
        // as a rock alone, the one that comes to a facet is rotated against it, and back
        let rotated = |turn: Rotation3<f64>, (v, w): Twist| (turn * v, turn * w);
        if let Some(turn) = &blow.turn {
            bodies[0].motion = rotated(turn.inverse(), bodies[0].motion);
        }
        let whole = || {
            let after = frozen_collision(&bodies, contacts, self.impact_tolerance())?;
            Some(Breakage { after, stems: ArrayVec::new() })
        };
        let mut thrown = scene.broken_by(&touching.rocks, &bodies, contacts).or_else(whole)?;
        if let Some(turn) = blow.turn {
            thrown.after.motions[0] = rotated(turn, thrown.after.motions[0]);
        }
        Some(thrown)
    }

    /// Books what the contacts of a blow took; what each rock lost in its contacts (J), and what trees took.
    fn book(
        &mut self,
        scene: &ImpactScene,
        StruckRocks { touching, rocks }: &StruckRocks,
        contacts: &[FrozenContact],
        after: &FrozenCollision,
    ) -> ([f64; BODIES], ArrayVec<TakenByTree, CONTACTS>) {
        let mut taken_j = [0.0; BODIES];
        let mut by_trees = ArrayVec::new();
        let (pairs, meshes) = contacts.split_at(touching.pairs.len());
        for ((contact, loss), pair) in pairs.iter().zip(&after.loss).zip(&touching.pairs) {
            let ContactEnds { first, second, .. } = contact.ends;
            for end in [Some(first), second].into_iter().flatten() {
                taken_j[end] += 0.5 * loss.sum();
                self.given[touching.rocks[end]].lost += 0.5 * loss.sum();
            }
            self.struck[*pair] = true;
        }
        let on_mesh = touching.rocks.iter().zip(rocks).filter(|(_, rock)| rock.on_mesh);
        let touches = on_mesh
            .flat_map(|(rock, _)| scene.members[*rock].state.touches.iter().map(|at| (*rock, at)));
        for ((k, contact), (rock, at)) in (pairs.len()..).zip(meshes).zip(touches) {
            let (loss, approach_m_s) = (&after.loss[k], after.fastest_m_s[k]);
            let world = scene.members[rock].environment(scene.terrain);
            taken_j[contact.ends.first] += loss.sum();
            self.losses[rock].add(&loss.on(&world, at.triangle), 1.0);
            if scene.terrain.is_tree(at.triangle) {
                by_trees.push((rock, at.triangle, loss.sum()));
            }
            if approach_m_s >= capture_m_s(contact.law) {
                let centre = (&rocks[contact.ends.first].c, world.body.radius);
                self.hits.push(hit_of(rock, at, centre, approach_m_s));
            }
        }
        (taken_j, by_trees)
    }

    /// Lets the rocks go on from a blow, `s` (s) before the end of the step. What none of their contacts took has been handed on.
    fn go_on_from(
        &mut self,
        StruckRocks { touching, rocks }: &StruckRocks,
        after: &FrozenCollision,
        (taken_j, s): ([f64; BODIES], f64),
    ) {
        // its own ends stand first, and are noted
        for &rock in &touching.rocks[self.in_blow.len()..] {
            self.begin_blow(rock, s);
        }
        self.in_blow.clear();
        for (k, (&rock, from)) in touching.rocks.iter().zip(rocks).enumerate() {
            let ball = &mut self.balls[rock];
            let (v, w) = after.motions[k];
            let body = &ball.body;
            let lost_j = body.motion_j((&from.v, &ball.w)) - body.motion_j((&v, &w));
            self.given[rock].passed_on += lost_j - taken_j[k];
            // what weight and contacts add in the rest of the step stays
            ball.v += v - from.v;
            ball.c += (v - from.v) * s;
            ball.w = w;
            ball.note_impact(s);
            self.in_blow.push(rock);
        }
    }

    /// With how many rocks a blow is followed; `None` if with its own ends alone.
    fn reach(&self, scene: &ImpactScene, blow: &BlowStart) -> Option<Reach> {
        if self.balls.len() <= BODIES {
            return Some(Reach::ALL);
        }
        if self.in_blow.iter().any(|&rock| self.balls[rock].body.is_struck_hard(blow.approach_m_s))
        {
            return Some(Reach::NEAREST);
        }
        self.is_between(scene, blow).then_some(Reach::ON_MESH)
    }

    /// Whether a blow presses a rock onto the mesh, by its last look, that is much lighter than the one which strikes it.
    fn is_between(&self, scene: &ImpactScene, blow: &BlowStart) -> bool {
        let Some(pair) = blow.pair else { return false };
        let pair = &scene.pair_histories[pair];
        let [a, b] = [pair.a, pair.b].map(|k| k as usize);
        let (n, _) = normal_and_distance(&self.balls[a].c, &self.balls[b].c);
        let masses = [a, b].map(|k| self.balls[k].body.mass);
        let (light, push) = if masses[0] < masses[1] { (a, n) } else { (b, -n) };
        let IslandBody { state, body, .. } = &*scene.members[light];
        let reach = body.radius * (1.0 + BESIDE_MESH);
        let presses = |touch: &ContactPoint| touch.normal.dot(&push) < PRESSED_ON;
        masses[0].max(masses[1]) > MUCH_LIGHTER * body.mass
            && state.touches.iter().any(|touch| touch.distance_m <= reach && presses(touch))
    }

    /// Rocks that touch the ends of a blow, and those that touch these; `None` if they are more than it reaches.
    fn touching(
        &self,
        scene: &ImpactScene,
        blow: &BlowStart,
        (s, reach): (f64, Reach),
    ) -> Option<TouchingRocks> {
        let mut touching = TouchingRocks::default();
        touching.rocks.extend(self.in_blow.iter().copied());
        touching.pairs.extend(blow.pair);
        let mut next = 0;
        while let Some(&rock) = touching.rocks.get(next) {
            next += 1;
            for place in self.of_rocks.places(rock) {
                let pair = self.of_rocks.at(place);
                let ends = [scene.pair_histories[pair].a, scene.pair_histories[pair].b];
                let [a, b] = ends.map(|k| &self.balls[k as usize]);
                let (at, from) = (a.before_end(s), b.before_end(s));
                let (n, distance) = normal_and_distance(&at.0, &from.0);
                let least = a.body.radius.min(b.body.radius);
                let room = blow.closes_m(-n.dot(&(at.1 - from.1)), least).max(HELD * least);
                let is_touch = distance <= a.body.radius + b.body.radius + room;
                if is_touch && touching.add(pair, ends, reach).is_none() && !reach.or_nearest {
                    return None;
                }
            }
        }
        Some(touching)
    }

    /// The contacts of a blow: pairs, then those with the mesh rock by rock; `None` if they are too many.
    fn contacts<'s>(
        &self,
        scene: &'s ImpactScene,
        StruckRocks { touching, rocks }: &StruckRocks,
        blow: &BlowStart,
    ) -> Option<ArrayVec<FrozenContact<'s>, CONTACTS>> {
        let mut contacts = ArrayVec::new();
        let captured =
            touching.rocks.iter().any(|rock| self.balls[*rock].impacts >= REBOUNDS_IN_STEP);
        let mut add = |contact: FrozenContact<'s>| -> Option<()> {
            contacts.try_push(FrozenContact { captured, ..contact }).ok()
        };
        for &pair in &touching.pairs {
            let pair_history = &scene.pair_histories[pair];
            let place = |end: u32| touching.rocks.iter().position(|rock| *rock == end as usize);
            let (first, second) = (place(pair_history.a)?, place(pair_history.b)?);
            let (normal, distance) = normal_and_distance(&rocks[first].c, &rocks[second].c);
            let radius = |k: usize| self.balls[touching.rocks[k]].body.radius;
            // one common point, as in every contact of two rocks
            let reach = radius(first) + radius(second);
            let ends = ContactEnds { first, second: Some(second), levers: [distance / reach; 2] };
            let gap_m = blow.gap_m(
                distance - reach,
                radius(first).min(radius(second)),
                pair_history.closed,
            );
            let law = &pair_history.law;
            add(FrozenContact { normal, law, gap_m, ends, ..FrozenContact::none() })?;
        }
        for (first, rock) in touching.rocks.iter().enumerate().filter(|(k, _)| rocks[*k].on_mesh) {
            let world = scene.members[*rock].environment(scene.terrain);
            let (state, radius) = (&scene.members[*rock].state, world.body.radius);
            for touch in state.touches.iter() {
                let is_held = scene.members[*rock].is_held_on(touch.feature);
                let gap_m =
                    blow.gap_m(touch.distance_m - blow.reach_m(first, radius), radius, is_held);
                add(FrozenContact {
                    normal: touch.normal,
                    law: world.law(touch.triangle),
                    stiffness_scale: touch.gain2,
                    gap_m,
                    ends: ContactEnds { first, ..ContactEnds::MESH },
                    ..FrozenContact::none()
                })?;
            }
        }
        Some(contacts)
    }
}

impl StruckRocks {
    /// Looks for what the rocks touch of the mesh.
    fn look(&mut self, scene: &mut ImpactScene, blow: &BlowStart) {
        for (k, (&rock, at)) in self.touching.rocks.iter().zip(&mut self.rocks).enumerate() {
            let (world, state) = scene.members[rock].with_environment(scene.terrain);
            let radius = world.body.radius;
            let reach = blow.reach_m(k, radius);
            state.find_contact_points(&world, &at.c, reach + WIDEST * radius);
            state.touches.retain(|touch| {
                let room = blow.closes_m(-touch.normal.dot(&at.v), radius).max(HELD * radius);
                touch.distance_m <= reach + room
            });
            at.on_mesh = !state.touches.is_empty();
        }
    }
}
