//! The journey of a block: tumble, touch, step, stop. Scheme `rigid` only.

use super::calm::Calm;
use super::fall::Course;
use super::form::{Form, Turned};
use super::journey::{Journey, Keep};
use super::{ShapeOf, Stop, Trajectory};
use crate::body::Block;
use crate::flight::block::{Tumble, first_touch};
use crate::flight::top::Top;
use crate::flight::{Landing, Parabola};
use crate::ground::Law;
use crate::release::{Drawn, Release};
use crate::rock::{Motion, Vec3};
use crate::step::block::{Footing, Moving, law_body};
use crate::step::world::World;

/// One block on its way.
struct Roll<'a> {
    course: &'a Course<'a>,
    world: World<'a>,
    block: &'a Block,
    footing: &'a mut Footing,
    moving: Moving,
    journey: Journey<'a>,
}

/// Follows one block from its release to its stop; `laws` are those of the grounds for it.
pub(super) fn follow_block(
    course: &Course,
    (release, drawn): (&Release, &Drawn),
    keep: Keep,
    laws: &[Law],
    footing: &mut Footing,
) -> Trajectory {
    let block = &drawn.block;
    let world = World { terrain: course.terrain, body: law_body(block, course.gravity_m_s2), laws };
    footing.near.forget();
    footing.near.gone.clear();
    (footing.near.tested, footing.sweeps) = (0, 0);
    let moving = Moving::new(block, (release.motion.position_m, drawn.attitude), &release.motion);
    let form = Form { rock: release.rock, block: Some(block) };
    let turned = turned(block, &moving);
    let start = (release.motion, Some(turned));
    let journey = Journey::new(course.terrain, form, start, (keep, course.watch));
    let mut roll = Roll { course, world, block, footing, moving, journey };
    let stop = loop {
        if let Some(stop) = roll.fly().or_else(|| roll.touch()) {
            break stop;
        }
    };
    roll.end((release, drawn), stop)
}

fn turned(block: &Block, moving: &Moving) -> Turned {
    let rotational_j = 0.5 * moving.spin(block).dot(&moving.momentum);
    Turned { attitude: moving.pose.attitude, rotational_j }
}

impl Roll<'_> {
    /// Leaps to the next touch.
    fn fly(&mut self) -> Option<Stop> {
        let Motion { time_s, position_m, velocity_m_s, .. } = self.journey.now;
        let block = self.block;
        let path = Parabola {
            start: position_m,
            velocity: velocity_m_s,
            gravity: self.course.gravity_m_s2,
            radius: block.bound_m,
        };
        let top = Top::new(block.inertia_kg_m2, self.moving.pose.attitude, self.moving.momentum);
        let left = self.course.longest_s - time_s;
        let tumble = Tumble { block, top, path };
        let landing = first_touch(self.course.terrain, &tumble, left, &mut self.footing.near);
        let (dt, stop) = match landing {
            Landing::Touch(t) => (t, None),
            Landing::Leaves(t) => (t, Some(Stop::LeftTerrain)),
            Landing::Flies => (left, Some(Stop::TimeUp)),
        };
        // a touch at the very end of the time comes too late
        let stop = stop.or_else(|| (dt >= left).then_some(Stop::TimeUp));
        self.journey.effort.leaps += 1;
        self.journey.fly(&path, Some(&top), dt);
        self.moving.pose = tumble.pose(dt);
        self.moving.v = self.journey.now.velocity_m_s;
        stop.or_else(|| self.over_budget())
    }

    fn over_budget(&self) -> Option<Stop> {
        let most = self.course.step.scheme.most_work();
        (self.journey.effort.work() > most).then_some(Stop::OverBudget)
    }

    /// Goes on in contact until the block is free again or stops.
    fn touch(&mut self) -> Option<Stop> {
        let (before_j, lost_before_j) = (self.total_j(), self.journey.lost_j());
        let stop = self.steps();
        let rise_j = self.total_j() - before_j;
        let ledger = &mut self.journey.ledger;
        ledger.rise_j = ledger.rise_j.max(rise_j);
        let lost_j = self.journey.lost_j() - lost_before_j;
        self.journey.ledger.remainder_j -= rise_j + lost_j;
        self.journey.end_impact();
        stop
    }

    fn steps(&mut self) -> Option<Stop> {
        let block = self.block;
        let mut calm = Calm::from(self.moving.pose.centre);
        loop {
            let pose = self.moving.pose;
            self.footing.look(&self.world, block, &pose, block.ball_m);
            if self.strike() {
                return None;
            }
            let left = self.course.longest_s - self.journey.now.time_s;
            let most_s = self.course.step.step_s.min(left);
            let done = self.footing.step(&self.world, block, &mut self.moving, most_s);
            self.journey.effort.steps += 1;
            self.journey.pay(&done.loss, 1.0);
            let to = Motion {
                time_s: self.journey.now.time_s + done.dt,
                position_m: self.moving.pose.centre,
                velocity_m_s: self.moving.v,
                spin_rad_s: self.moving.spin(block),
            };
            let finite = to.position_m.iter().chain(to.spin_rad_s.iter()).all(|x| x.is_finite());
            if !finite {
                return Some(Stop::Failed("motion is no longer finite".to_owned()));
            }
            self.journey.turned = Some(turned(block, &self.moving));
            self.journey.step(to, done.slides);
            let time_up = (done.dt >= left).then_some(Stop::TimeUp);
            let ends = time_up.or_else(|| self.over_budget());
            if done.is_free || ends.is_some() {
                return ends;
            }
            calm.note(done.dt, &to, block.bound_m, &self.course.rest);
            if calm.rests() {
                return Some(Stop::AtRest);
            }
        }
    }

    /// Resolves the impact of the contacts that touch, if there is one; whether it has thrown the block off.
    fn strike(&mut self) -> bool {
        let (block, now_s) = (self.block, self.journey.now.time_s);
        let struck: Vec<_> = self
            .footing
            .touching(block)
            .filter(|touch| Footing::is_struck(&self.world, (block, &self.moving), touch))
            .copied()
            .collect();
        for touch in &struck {
            let point = self.moving.pose.centre + touch.lever;
            self.journey.begin_impact(point, touch.feature.kind, touch.triangle, now_s);
        }
        let Some(loss) = self.footing.strike(&self.world, block, &mut self.moving) else {
            return false;
        };
        self.journey.pay(&loss, 1.0);
        self.journey.now.velocity_m_s = self.moving.v;
        self.journey.now.spin_rad_s = self.moving.spin(block);
        self.journey.turned = Some(turned(block, &self.moving));
        self.journey.note_speed();
        self.journey.end_impact();
        !self.footing.holds(&self.world, (block, &self.moving), true)
    }

    /// Mechanical energy (J), weight included.
    fn total_j(&self) -> f64 {
        let weight: Vec3 = self.world.body.gravity * self.block.mass_kg;
        self.moving.motion_j(self.block) - weight.dot(&self.moving.pose.centre)
    }

    fn end(mut self, (release, drawn): (&Release, &Drawn), stop: Stop) -> Trajectory {
        let start =
            Moving::new(self.block, (release.motion.position_m, drawn.attitude), &release.motion);
        self.journey.end_path();
        self.journey.effort.sweeps += self.footing.sweeps;
        self.journey.effort.triangles += self.footing.near.tested;
        let fallen = release.motion.position_m.z - self.journey.now.position_m.z;
        let weight_j = self.block.mass_kg * self.course.gravity_m_s2 * fallen;
        let released_j = weight_j + start.motion_j(self.block);
        let shape = Some(ShapeOf::new(drawn));
        Trajectory { shape, ..self.journey.into_trajectory(release, stop, released_j) }
    }
}
