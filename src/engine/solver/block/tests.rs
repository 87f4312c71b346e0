use super::*;

mod blow;
mod cases;
mod clamp;
mod foot;
mod gentle;
mod kept;
mod ledger;
mod limit;
mod prism;
mod rolling;
mod rolls;
mod slip;
mod springs;
mod yielding;

use crate::body::{Shape, Solid, Surface, box_surface, eota, prism_surface};
use crate::flight::block::{BlockFlight, first_touch};
use crate::flight::top::Top;
use crate::flight::{FlightEnd, Parabola};
use crate::ground::{Capture, Damping, Ground, Law};
use crate::math::{atan, cos, sin, turn};
use crate::rock::Rock;
use crate::solver::body::Body;
use crate::solver::{CORNER_WAY, Settings};
use crate::terrain::stl::{Facet, Soup};
use crate::terrain::weld::{Piece, Up, weld};
use crate::terrain::{Sheet, Terrain};
use std::path::Path;

/// Gravity of the exact cases (m/s²).
const G: f64 = 9.81;
/// A capture speed above every impact of a case (m/s): no impact rebounds.
const TOO_SLOW_M_S: f64 = 100.0;

fn terrain(facets: Vec<Facet>) -> Terrain {
    let soup = Soup::from(facets);
    let piece = Piece { file: Path::new("made"), soup: &soup, up: Up::Z, scale: 1.0, sheet: 0 };
    let welded = weld(&[piece], Vec3::zeros(), Some(1e-9)).unwrap();
    Terrain::new(welded, vec![Sheet { path: "made".into(), ground: 0, is_tree: false }])
}

/// A plane through the origin that falls along x at an angle (rad).
fn slope(angle: f64, half_m: f64) -> Terrain {
    let (along, _) = axes(angle);
    let at = |x: f64, y: f64| along * (half_m * x) + Vec3::y() * (half_m * y);
    let [a, b, c, d] = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
    terrain(vec![[a, b, c], [a, c, d]])
}

/// Directions along and out of a slope that falls along x.
fn axes(angle: f64) -> (Vec3, Vec3) {
    (Vec3::new(cos(angle), 0.0, -sin(angle)), Vec3::new(sin(angle), 0.0, cos(angle)))
}

/// A block of 2700 kg/m³ with this surface (m) and its frame, rounded by `ball_m`.
fn block(surface: &Surface, ball_m: f64) -> Block {
    let solid = Solid::of(surface);
    let radius_m = solid.equal_radius();
    let shape = Shape::of(&solid, &surface.points, ball_m / radius_m).unwrap();
    Block::new(&shape, &Rock { radius_m, density_kg_m3: 2700.0 })
}

/// One block on a mesh, simulated without a recorder.
struct BlockRun {
    terrain: Terrain,
    block: Block,
    law: Law,
    ground: Ground,
    step_s: f64,
    /// The step of a scheme with springs; `None` = `rigid`.
    springs: Option<Settings>,
    lost: Loss,
    /// Impacts; with springs, episodes of contact that are over.
    impacts: usize,
    steps: usize,
}

/// The law of a ground for a block, whose impacts slower than so much (m/s) do not rebound.
fn law_of(ground: &Ground, block: &Block, capture_m_s: f64) -> Law {
    let rock = Rock { radius_m: block.radius_m, density_kg_m3: 2700.0 };
    let capture = Capture { own_m_s: Some(capture_m_s), tolerance_m_s: 0.0, gravity_m_s2: G };
    Law::new(ground, &Damping::of(ground.restitution), &rock, &capture)
}

impl BlockRun {
    fn new(terrain: Terrain, block: Block, (friction, e): (f64, f64)) -> Self {
        let ground = Ground::smooth([1e9, 0.25e9], atan(friction), Some(e));
        // below that speed an elastic block would lose energy by capture
        let law = law_of(&ground, &block, if e < 1.0 { 1e-3 } else { 0.0 });
        let lost = Loss::default();
        let springs = None;
        Self { terrain, block, law, ground, step_s: 0.01, springs, lost, impacts: 0, steps: 0 }
    }

    fn start(&self, attitude: Rotation3<f64>, [centre, v, w]: [Vec3; 3]) -> BlockState {
        let motion = Motion { time_s: 0.0, position_m: centre, velocity_m_s: v, spin_rad_s: w };
        BlockState::new(&self.block, (centre - self.terrain.origin_m, attitude), &motion)
    }

    /// Simulates it for `longest_s`; `see` gets the time and the motion after every flight, impact
    /// and step.
    fn follow(
        &mut self,
        state: &mut BlockState,
        longest_s: f64,
        mut see: impl FnMut(f64, &BlockState),
    ) {
        let (block, laws) = (self.block.clone(), [self.law]);
        let world = ContactEnvironment {
            terrain: &self.terrain,
            body: Body::of_block(&block, G),
            laws: &laws,
        };
        let (mut contact_state, mut now) = (BlockContactState::default(), 0.0);
        contact_state.slip.begin(&[self.ground]);
        while now < longest_s {
            let path = Parabola {
                start: state.pose.centre,
                velocity: state.v,
                gravity: G,
                radius: block.bound_m,
            };
            let top = Top::new(block.inertia_kg_m2, state.pose.attitude, state.momentum);
            let tumble = BlockFlight { block: &block, top, path };
            let left = longest_s - now;
            let dt = match first_touch(
                &self.terrain,
                &tumble,
                left,
                (&mut contact_state.near, &mut contact_state.window),
            ) {
                FlightEnd::Touch(dt) => dt,
                FlightEnd::Flies => left,
                FlightEnd::Leaves(_) => panic!("it has left the plane after {now} s"),
            };
            (state.pose, state.v) = (tumble.pose(dt), path.velocity(dt));
            now += dt;
            see(now, state);
            if let Some(settings) = &self.springs {
                contact_state.begin_springs(&world, settings, (&block, state));
            }
            while now < longest_s {
                if let Some(settings) = &self.springs {
                    let on = (&block, &mut *state);
                    let done = contact_state.step_on_springs(&world, settings, on, longest_s - now);
                    let (done, _) = done.unwrap_or_else(|why| {
                        panic!(
                            "{:?} after {now} s: {why}; {:?}",
                            settings.scheme, contact_state.touches.found
                        )
                    });
                    self.lost.add(&done.loss, 1.0);
                    self.steps += 1;
                    now += done.dt;
                    see(now, state);
                    if done.is_free {
                        self.impacts += 1;
                        break;
                    }
                    continue;
                }
                let pose = state.pose;
                contact_state.detect(&world, &block, &pose, block.ball_m);
                if let Some(loss) = contact_state.strike(&world, &block, state) {
                    self.lost.add(&loss, 1.0);
                    self.impacts += 1;
                    see(now, state);
                    if !contact_state.stays_in_contact(&world, (&block, state), true) {
                        break;
                    }
                }
                let most = (self.step_s.min(longest_s - now), CORNER_WAY);
                let done = contact_state.step(&world, &block, state, most);
                self.lost.add(&done.loss, 1.0);
                self.steps += 1;
                now += done.dt;
                see(now, state);
                if done.is_free {
                    break;
                }
            }
        }
    }

    fn energy_j(&self, state: &BlockState) -> f64 {
        state.motion_j(&self.block) + self.block.mass_kg * G * state.pose.centre.z
    }
}

fn still(centre: Vec3) -> [Vec3; 3] {
    [centre, Vec3::zeros(), Vec3::zeros()]
}

fn tilted(angle: f64) -> Rotation3<f64> {
    turn(&Vec3::y_axis(), angle)
}

/// A cube at rest on 20° stays where it is for 100 s.
#[test]
fn a_cube_rests_without_creeping() {
    let angle = 20_f64.to_radians();
    let mut case =
        BlockRun::new(slope(angle, 10.0), block(&box_surface([1.0; 3]), 0.05), (1.0, 0.4));
    let mut state = case.start(tilted(angle), still(axes(angle).1 * 0.5));
    let start = state.pose.centre;
    case.follow(&mut state, 100.0, |_, _| ());
    let way = (state.pose.centre - start).norm();
    assert!(way < 1e-6 && state.v.norm() < 1e-9, "{way:e} {:e}", state.v.norm());
}

/// A cube slides on its face at 40° with μ = 0.5: a = g (sin 40° − 0.5 cos 40°) = 2.5483 m/s², and
/// does not turn.
#[test]
fn a_cube_slides_as_a_point_does() {
    let angle = 40_f64.to_radians();
    let mut case =
        BlockRun::new(slope(angle, 100.0), block(&box_surface([1.0; 3]), 0.05), (0.5, 0.4));
    let (along, up) = axes(angle);
    let mut state = case.start(tilted(angle), still(up * 0.5));
    case.follow(&mut state, 4.0, |_, _| ());
    let a = G * (sin(angle) - 0.5 * cos(angle));
    assert!((a - 2.5483).abs() < 1e-4);
    assert!((state.v.dot(&along) / (4.0 * a) - 1.0).abs() < 1e-8, "{}", state.v.dot(&along));
    let spin = state.spin(&case.block).norm();
    assert!(state.v.dot(&up).abs() < 1e-8 && spin < 1e-8, "{} {spin}", state.v.dot(&up));
}

/// A cube on 50° with μ = 1.3 begins to tip about its lower edge with ¾ g/a (sin 50° − cos 50°);
/// the balls at the corners set that edge a little inside.
#[test]
fn a_cube_tips_about_its_lower_edge() {
    let angle = 50_f64.to_radians();
    let ball = 0.01;
    let mut case =
        BlockRun::new(slope(angle, 100.0), block(&box_surface([1.0; 3]), ball), (1.3, 0.0));
    let mut state = case.start(tilted(angle), still(axes(angle).1 * 0.5));
    case.follow(&mut state, 0.02, |_, _| ());
    let sharp = 0.75 * G * (sin(angle) - cos(angle));
    assert!((sharp - 0.9068).abs() < 1e-4);
    let arm = 0.5 - ball;
    let rounded = G * (0.5 * sin(angle) - arm * cos(angle)) / (1.0 / 6.0 + 0.25 + arm * arm);
    let found = state.spin(&case.block).y / 0.02;
    assert!((found / rounded - 1.0).abs() < 2e-3, "{found} {rounded}");
}

/// A box 2 x 0.2 x 0.2 m tilted by 30° falls at 3 m/s on its lower corners, without friction, e =
/// 0.5: with the lever of those corners its centre keeps `v' = −v + (1 + e) v m_n/m`, and it spins
/// with `m_n (1 + e) v a/I`.
#[test]
fn a_tilted_box_is_thrown_by_its_corners() {
    for ball in [0.002, 0.02] {
        let mut case =
            BlockRun::new(slope(0.0, 50.0), block(&box_surface([2.0, 0.2, 0.2]), ball), (0.0, 0.5));
        let angle = 30_f64.to_radians();
        let attitude = tilted(angle);
        let low = attitude * Vec3::new(1.0 - ball, 0.1 - ball, -0.1 + ball);
        let centre = Vec3::z() * (ball - low.z);
        let mut state = case.start(attitude, [centre, Vec3::z() * -3.0, Vec3::zeros()]);
        let (block, laws) = (case.block.clone(), [case.law]);
        let world = ContactEnvironment {
            terrain: &case.terrain,
            body: Body::of_block(&block, G),
            laws: &laws,
        };
        let mut contact_state = BlockContactState::default();
        let pose = state.pose;
        contact_state.detect(&world, &block, &pose, block.ball_m);
        assert_eq!(contact_state.touching(&block).count(), 2);
        let loss = contact_state.strike(&world, &block, &mut state).unwrap();
        let (arm, inertia) = (low.x, 4.04 / 12.0);
        let share = 1.0 / (1.0 + arm * arm / inertia);
        assert!((state.v.z - (-3.0 + 4.5 * share)).abs() < 1e-9, "{}", state.v.z);
        let spin = state.spin(&block);
        assert!((spin.norm() - 4.5 * share * arm / inertia).abs() < 1e-9, "{spin}");
        if ball < 0.01 {
            // the sharp corner's digits
            assert!((share - 0.335_805_618_7).abs() < 2e-3 && (state.v.z + 1.488_87).abs() < 5e-3);
        }
        let lost = 0.5 * block.mass_kg * 0.75 * 9.0 * share;
        assert!((loss.damping / lost - 1.0).abs() < 1e-9 && loss.friction == 0.0, "{loss:?}");
        case.impacts += 1;
    }
}

/// A regular prism with its axis along y and a face down.
fn prism_on_its_side(sides: u32) -> Surface {
    let mut surface = prism_surface(sides, 0.5);
    let first = std::f64::consts::FRAC_PI_2 - std::f64::consts::PI / f64::from(sides);
    let turned = turn(&Vec3::y_axis(), first) * turn(&Vec3::x_axis(), -std::f64::consts::FRAC_PI_2);
    for p in &mut surface.points {
        *p = turned * *p;
    }
    surface
}

/// A plastic impact of a rolling prism from one edge to the next: ω'/ω = η = (k + cos 2π/n)/(k +
/// 1), k = I/(m ρ²), for any number of corners; rounded corners put the edges at the distance ρ, a
/// little inside.
#[test]
fn a_slap_takes_what_it_must() {
    for (sides, sharp) in [(4, 0.25), (5, 0.501_036_279_4), (6, 11.0 / 17.0), (8, 0.798_169_546_2)]
    {
        let ball = 0.001;
        let mut case =
            BlockRun::new(slope(0.0, 50.0), block(&prism_on_its_side(sides), ball), (10.0, 0.0));
        case.law = law_of(&case.ground, &case.block, TOO_SLOW_M_S);
        let corners = &case.block.core.corners;
        let low = corners.iter().map(|p| p.z).fold(f64::MAX, f64::min);
        let half = corners.iter().filter(|p| p.z < low + 1e-6).map(|p| p.x).fold(0.0, f64::max);
        let height = ball - low;
        let inertia = case.block.inertia_kg_m2[1] / case.block.mass_kg;
        // it has turned about the rear edge until the front edge lands
        let spin = Vec3::y();
        let arm = Vec3::new(half, 0.0, height);
        let mut state =
            case.start(Rotation3::identity(), [Vec3::z() * height, spin.cross(&arm), spin]);
        case.follow(&mut state, 1e-9, |_, _| ());
        let found = state.spin(&case.block).y;
        let known =
            (inertia + height * height - half * half) / (inertia + height * height + half * half);
        assert!((found - known).abs() < 1e-6, "{sides}: {found} {known}");
        assert!((known - sharp).abs() < 0.01, "{sides}: {known} {sharp}");
    }
}

/// e = 1 without friction: a box bounces hundreds of times and keeps energy, horizontal momentum
/// and spin about the vertical.
#[test]
fn a_frictionless_elastic_box_keeps_what_it_should() {
    let mut case =
        BlockRun::new(slope(0.0, 1e5), block(&box_surface([3.0, 2.0, 1.0]), 0.1), (0.0, 1.0));
    let start = [Vec3::z() * 5.0, Vec3::new(1.0, 0.5, 0.0), Vec3::new(0.3, -2.0, 1.0)];
    let mut state = case.start(Rotation3::identity(), start);
    let (before, about) = (case.energy_j(&state), state.momentum.z);
    case.follow(&mut state, 300.0, |_, _| ());
    assert!(case.impacts > 100 && case.steps < case.impacts, "{} {}", case.impacts, case.steps);
    assert!((state.v.x - 1.0).abs() < 1e-12 && (state.v.y - 0.5).abs() < 1e-12);
    assert!((state.momentum.z / about - 1.0).abs() < 1e-9, "{} {about}", state.momentum.z);
    let change = case.energy_j(&state) / before - 1.0;
    assert!(change.abs() < 1e-9, "{change:e}");
}
