//! What is no plane: folds, noise, triangles far smaller than the rock. Energy is watched at the end of every step.

use super::bounds::{DIGITS, SpringImpact, impact_error};
use super::impacts::rebound_m_s;
use super::{Notes, SchemeSetting, sprung};
use crate::flight::{FlightEnd, Parabola, time_of_impact};
use crate::ground::{Capture, Damping, Ground, Law};
use crate::math;
use crate::rock::{Rock, Vec3};
use crate::simulation::Stop;
use crate::solver::body::Body;
use crate::solver::contact_state::{ContactEnvironment, ContactState};
use crate::solver::step_control::ROUNDING;
use crate::solver::{Stepper, advance};
use crate::study::bench::{GROUND, ROCK, SETUP, Setup, settings, terrain, with_springs};
use crate::study::cases::meshes::{bumpy, fold};
use crate::terrain::{Sheet, Terrain};
use std::f64::consts::PI;

/// What the energy of a rock did, springs included.
struct Energy {
    /// At the end over that at the start (–).
    kept: f64,
    /// Largest rise over what an episode had left at an earlier step (–, relative to the start).
    rise: f64,
}

/// A rock stepped by hand, its energy taken at the end of every step: what the dashpots take hides no gain.
struct Watched<'t> {
    world: ContactEnvironment<'t>,
    state: ContactState,
    /// Looks without touching what the steps know.
    probe: ContactState,
    is_sprung: bool,
}

impl Watched<'_> {
    /// Motion, height and springs (J).
    fn energy_j(&mut self) -> f64 {
        let Self { world, state, probe, is_sprung } = self;
        let body = &world.body;
        let moving = state.motion_j(body) - body.mass * body.gravity.dot(&state.c);
        if !*is_sprung {
            return moving;
        }
        (probe.c, probe.histories) = (state.c, state.histories.clone());
        moving + probe.springs_j(world).sum()
    }

    /// Goes on from a touch until the rock is free or `left_s` is over; the largest rise (J). `None` if a step fails.
    fn episode(&mut self, way: &SchemeSetting, left_s: &mut f64) -> Option<f64> {
        let step = settings(way.scheme, way.fineness, None);
        let mut stepper = Stepper::new(&step, &self.world, &mut self.state);
        let (mut least, mut rise) = (self.energy_j(), 0.0f64);
        while *left_s > 0.0 {
            let done = advance(&mut stepper, &self.world, &mut self.state, *left_s).ok()?;
            *left_s -= done.dt;
            let now = self.energy_j();
            (rise, least) = (rise.max(now - least), least.min(now));
            if self.state.is_free() {
                break;
            }
        }
        Some(rise)
    }
}

/// Follows a rock from touch to touch over these grounds, by the numbers of the terrain's sheets; nothing where a step fails.
fn watch(
    way: &SchemeSetting,
    (setup, grounds): (&Setup, &[Ground]),
    terrain: &Terrain,
    capture_m_s: Option<f64>,
) -> Option<Energy> {
    let capture =
        Capture { own_m_s: capture_m_s, tolerance_m_s: 0.0, gravity_m_s2: setup.gravity_m_s2 };
    let law =
        |ground: &Ground| Law::new(ground, &Damping::of(ground.restitution), &setup.rock, &capture);
    let laws: Vec<Law> = grounds.iter().map(law).collect();
    let body = Body::new(&setup.rock, setup.gravity_m_s2);
    let world = ContactEnvironment { terrain, body, laws: &laws };
    let (state, probe) = (ContactState::default(), ContactState::default());
    let mut rock = Watched { world, state, probe, is_sprung: sprung(way) };
    let start = setup.centre_m - terrain.origin_m;
    (rock.state.c, rock.state.v, rock.state.w) = (start, setup.velocity_m_s, setup.spin_rad_s);
    let mut left_s = setup.longest_s;
    let moving = rock.state.motion_j(&body);
    let scale = moving + body.mass * setup.gravity_m_s2 * setup.rock.radius_m;
    let (before, mut rise) = (rock.energy_j(), 0.0f64);
    while left_s > 0.0 {
        let flight = Parabola {
            start: rock.state.c,
            velocity: rock.state.v,
            gravity: setup.gravity_m_s2,
            radius: setup.rock.radius_m,
        };
        let FlightEnd::Touch(t) = time_of_impact(terrain, &flight, left_s, &mut 0) else {
            (rock.state.c, rock.state.v) = (flight.centre(left_s), flight.velocity(left_s));
            break;
        };
        left_s -= t;
        let w = rock.state.w;
        rock.state.begin(&rock.world, flight.centre(t), flight.velocity(t), w);
        rise = rise.max(rock.episode(way, &mut left_s)?);
    }
    let after = rock.energy_j();
    Some(Energy { kept: 1.0 + (after - before) / scale, rise: rise / scale })
}

/// What energy may rise by within an episode (–) on ground that turns by `turn` (–) from face to face.
///
/// The fixed step takes a fold as it is at its start, so it meets the next face up to a step late: a force of `p_N v/ω` over
/// `v Δt` times the turn, over the energy. The others err by what an impact does.
fn may_rise(way: &SchemeSetting, omega: f64, turn: f64) -> f64 {
    let error = impact_error(way, omega);
    if way.scheme.has_fixed_step() { 2.0 * error * turn + DIGITS } else { error }
}

/// What energy may change by over all (–): implicit steps give an impact that takes nothing the energy that it had, the fixed
/// step damps. It keeps `exp(−π ω Δt/4)` of the speed in each of two impacts.
fn may_change(way: &SchemeSetting, omega: f64, turn: f64) -> f64 {
    let damped = 1.0 - math::exp(-PI * omega * way.fineness) + may_rise(way, omega, turn);
    if way.scheme.has_fixed_step() { damped } else { DIGITS }
}

/// Holds that nothing is lost and nothing gained.
fn conserve(
    way: &SchemeSetting,
    notes: &mut Notes,
    setting: &str,
    (setup, terrain, turn): (&Setup, &Terrain, f64),
) {
    let omega = setup.omega();
    let energy = watch(way, (setup, &[setup.ground]), terrain, Some(0.0));
    let (change, rise) =
        energy.map_or((f64::NAN, f64::NAN), |energy| ((energy.kept - 1.0).abs(), energy.rise));
    let law = "change of energy where nothing takes any";
    notes.hold(way, setting, law, change, may_change(way, omega, turn));
    let law = "rise within an episode, losses not netted";
    notes.hold(way, setting, law, rise, may_rise(way, omega, turn));
}

fn elastic_ground(stiffness: f64) -> Ground {
    Ground { friction_angle_rad: 0.0, restitution: Some(1.0), ..with_springs(GROUND, stiffness) }
}

/// e = 1 without friction on valleys from the bluntest to the sharpest, beside the bottom and in it.
pub(super) fn elastic(way: &SchemeSetting, notes: &mut Notes) {
    for angle in [1e-6, 1e-3, 0.02, 0.2, 0.6, 2.0] {
        let valley = terrain(fold(angle, 4.0));
        for (stiffness, radius, speed) in [(1e9, 0.5, 10.0), (1e7, 0.05, 5.0), (1e12, 1.0, 50.0)] {
            for place in [-0.35, 0.0, 0.2] {
                let x = place * f64::min(angle, 0.6) * radius;
                let z = 1.2 * radius / math::cos(0.5 * angle) + x.abs() * math::tan(0.5 * angle);
                let setup = Setup {
                    rock: Rock { radius_m: radius, ..ROCK },
                    ground: elastic_ground(stiffness),
                    centre_m: Vec3::new(x, 0.1, z),
                    velocity_m_s: Vec3::new(0.2 * speed, 0.0, -speed),
                    longest_s: 1.2 * radius / speed,
                    ..SETUP
                };
                let setting =
                    format!("{angle} rad, {stiffness:.0e} N/m, R {radius} m, at {place} of it");
                conserve(way, notes, &setting, (&setup, &valley, angle));
            }
        }
    }
}

/// e = 1 without friction on noisy ground, from a tenth to fifty times the cells.
pub(super) fn noisy(way: &SchemeSetting, notes: &mut Notes) {
    for (cell, cells, noise) in [(10.0, 4, 0.2), (1.0, 6, 0.05), (0.1, 40, 0.01), (0.02, 140, 1e-3)]
    {
        // a fixed step would look at ten thousand triangles a thousand times
        if way.scheme.has_fixed_step() && cell < 0.1 {
            continue;
        }
        let ground = terrain(bumpy(cells, cell, noise));
        for place in [[0.03, -0.05], [-0.21, 0.14]] {
            let setup = Setup {
                rock: Rock { radius_m: 1.0, ..ROCK },
                ground: elastic_ground(1e9),
                centre_m: Vec3::new(place[0], place[1], 1.3),
                velocity_m_s: Vec3::new(2.0, 1.0, -10.0),
                longest_s: 0.1,
                ..SETUP
            };
            let setting = format!("R/cell {}, at {place:?}", 1.0 / cell);
            conserve(way, notes, &setting, (&setup, &ground, noise / cell));
        }
    }
}

/// Rocks that are thrown on borders of grounds: one in five to one in twenty comes from one to the other in its impact.
const THROWN: u32 = 60;

/// e = 1 without friction on noisy ground whose cells are in turn of a soft and a hard ground: springs hand over what they hold, or lose it, and
/// make none. The worst of many rocks is held.
pub(super) fn borders(way: &SchemeSetting, notes: &mut Notes) {
    for (cell, cells, noise) in [(1.0, 8, 0.05), (0.25, 32, 0.02)] {
        let ground = checkered(terrain(bumpy(cells, cell, noise)), cell);
        for stiff in [1e9, 1e10] {
            let setup = Setup { ground: elastic_ground(stiff), longest_s: 0.1, ..SETUP };
            let change = |k: u32| {
                let [x, y] = [0.618_034, 0.754_878].map(|step| (f64::from(k) * step).fract() - 0.5);
                let setup = Setup {
                    centre_m: Vec3::new(2.0 * x, 2.0 * y, 0.8),
                    velocity_m_s: Vec3::new(12.0, 1.0, -8.0),
                    ..setup
                };
                let grounds = [elastic_ground(1e8), setup.ground];
                let energy = watch(way, (&setup, &grounds), &ground, Some(0.0));
                energy.map_or(f64::NAN, |energy| energy.kept - 1.0)
            };
            let setting = format!("1e8 and {stiff:.0e} N/m, R/cell {}", 0.5 / cell);
            let changes: Vec<f64> = (0..THROWN).map(change).collect();
            let worst = |of: fn(f64) -> f64| changes.iter().copied().map(of).fold(0.0, larger);
            let error = impact_error(way, setup.omega()).max(DIGITS);
            if way.scheme.has_fixed_step() {
                let law = "energy made where nothing takes any, of 60 rocks";
                notes.hold(way, setting, law, worst(|change| change), error);
            } else {
                let law = "change of energy where nothing takes any, of 60 rocks";
                notes.hold(way, setting, law, worst(f64::abs), error);
            }
        }
    }
}

/// The larger of two; what is no number stays.
fn larger(one: f64, other: f64) -> f64 {
    if other <= one { one } else { other }
}

/// The same terrain with two grounds, cell by cell in turn.
fn checkered(mut terrain: Terrain, cell_m: f64) -> Terrain {
    let hard = Sheet { ground: 1, ..terrain.sheets[0].clone() };
    terrain.sheets.push(hard);
    for t in 0..terrain.sheet_of.len() {
        let face = terrain.face(t as u32);
        let middle = face.a + (face.e1 + face.e2) / 3.0 + terrain.origin_m;
        let cell = [middle.x, middle.y].map(|at| (at / cell_m).floor() as i64);
        terrain.sheet_of[t] = u16::from((cell[0] + cell[1]).rem_euclid(2) == 1);
    }
    terrain
}

/// e = 0.5 on noise that the rock does not see: it rebounds as from a plane. The rigid limit strikes one corner alone, and
/// rebounds from that.
pub(super) fn larger_than_cells(way: &SchemeSetting, notes: &mut Notes) {
    let cell = 0.1;
    for noise in [1e-3, 5e-3] {
        let ground = terrain(bumpy(40, cell, noise));
        let rock = Rock { radius_m: 1.5, ..ROCK };
        let setup = Setup {
            rock,
            ground: Ground { friction_angle_rad: 0.0, ..GROUND },
            centre_m: Vec3::new(0.02, 0.01, 1.5 + noise),
            velocity_m_s: Vec3::new(0.0, 0.0, -10.0),
            longest_s: 0.05,
            ..SETUP
        };
        let setting = format!("{noise} m uneven, R/cell 15");
        let journey = notes.follow(way, &setting, &setup, &ground);
        let failed = matches!(journey.stop, Stop::Failed(_));
        if sprung(way) && !failed {
            let blow = SpringImpact::of(&setup, 10.0, 0.5);
            let right = blow.closed_form();
            let off = (rebound_m_s(&journey, &setup) / right - 1.0).abs();
            // a face is inclined by noise over cell at the most: its normal is short of upright by half the square of that, and
            // the speed along it is as much; an error is twice as much of half the speed
            let inclined = (noise / cell).powi(2);
            let bound = inclined + 2.0 * impact_error(way, blow.omega);
            notes.hold(way, &setting, "rebound off that of a plane (–)", off, bound);
        }
    }
}

/// A rock thrown along noisy ground, rubbing, hopping, rolling: no step of an episode gains.
pub(super) fn slides(way: &SchemeSetting, notes: &mut Notes) {
    let ground = terrain(bumpy(60, 0.1, 1e-3));
    let setup = Setup {
        centre_m: Vec3::new(-1.5, 0.01, 0.501),
        velocity_m_s: Vec3::new(4.0, 0.3, -0.2),
        spin_rad_s: Vec3::new(1.0, -3.0, 2.0),
        longest_s: 0.5,
        ..SETUP
    };
    let energy = watch(way, (&setup, &[setup.ground]), &ground, None);
    let rise = energy.map_or(f64::NAN, |energy| energy.rise);
    let law = "rise within an episode, losses not netted";
    // what moves across the ground, of all: the fall, the throw, and the way up the faces, inclined by a hundredth
    let across = (0.2f64.powi(2) + 0.04f64.powi(2)) / 16.0;
    let turned = 4.0 * way.fineness / setup.rock.radius_m;
    // a step that gains more than the second is refused
    let bound = way.scheme.of([across * turned, ROUNDING, ROUNDING, DIGITS]);
    notes.hold(way, "R/cell 5, 1 mm uneven", law, rise, bound);
}
