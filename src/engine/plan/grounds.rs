//! What the grounds of a scene ask of the plan: stems that give way, sources of values, grounds without use.

use super::{Part, apart, can_exceed_0, slips, trees};
use crate::contact::pair::BondStrength;
use crate::error::{Error, Result};
use crate::ground::{Damping, Ground, Scar, swept_m3, tangential_restitution};
use crate::math;
use crate::release::NO_WIDTH_M;
use crate::rock::Rock;
use crate::scene::{GroundTable, Scene, known_ground};
use crate::terrain::Terrain;
use crate::terrain::stems::Stems;

/// Grounds with values of the catalogue: name, what was taken, source.
pub(super) fn catalogued(scene: &Scene) -> Vec<String> {
    let taken = |(name, ground): (&String, &GroundTable)| {
        let known = known_ground(ground.like.as_deref()?)?;
        let beside = known.beside.map_or_else(String::new, |beside| format!("; beside {beside}"));
        Some(format!(
            "{name} like {}: {} unless written in the scene{beside}; {}",
            known.name,
            known.values(),
            known.source
        ))
    };
    scene.grounds.iter().filter_map(taken).collect()
}

/// The stems that give way, whose ends leave nothing open.
pub(super) fn stems(scene: &Scene, terrain: &Terrain) -> Result<Option<Stems>> {
    let limits = scene.grounds.values().map(|ground| ground.breaks_above_j.clone()).collect();
    Stems::of(terrain, limits).map_err(|shared_m| {
        let [x, y, z]: [f64; 3] = (shared_m + terrain.origin_m).into();
        let found = format!("found a stem that shares a corner with what stays at ({x}, {y}, {z})");
        let remedy = "write stems that stand in the ground without common corners, as rockfall mesh stems makes them";
        Error::input(&scene.file, "[grounds] breaks_above_j", found, remedy)
    })
}

/// From the lowest to the highest ground there is less on Earth (m): 8 849 m from the sea to the summit of Mount Everest.
const HIGHEST_M: f64 = 1e4;

/// Refuses meshes so small that nothing can fall on them, or so high that no mountain is: their unit is another, most likely.
pub(super) fn check_size(scene: &Scene, terrain: &Terrain) -> Result<()> {
    let (low, high) = terrain.index.bounds();
    let (size_m, height_m) = ((high - low).max(), high.z - low.z);
    let found = if size_m < NO_WIDTH_M {
        format!("found meshes of {size_m:.1e} m in all")
    } else if height_m > HIGHEST_M {
        format!("found meshes that are {height_m:.0} m high in all, more than any mountain")
    } else {
        return Ok(());
    };
    let remedy = "write scale = metres in one unit of the file, 0.001 for millimetres, and leave out what is no ground";
    Err(Error::input(&scene.file, "[[terrain]] scale", found, remedy))
}

/// The steepest slope on which each ground stops a rolling sphere, `tan θ` = rolling friction, and keeps a block that lies on a face,
/// `tan θ` = friction: where a block stops rolling is a matter of its shape.
pub(super) fn rolling_stops(scene: &Scene) -> Vec<String> {
    let up_to = |[least, middle, most]: [f64; 3]| {
        let spread =
            if most > least { format!(" ({least:.1}° to {most:.1}°)") } else { String::new() };
        format!("on slopes of up to {middle:.1}°{spread}")
    };
    let spheres = |(name, ground): (&String, &GroundTable)| {
        let Some(rolling) = ground.rolling_friction.as_ref() else {
            return format!("{name}: on no slope, it has no rolling friction");
        };
        let slopes = up_to(rolling.reckoned().map(|value| math::atan(value).to_degrees()));
        format!("{name}: {slopes}")
    };
    let blocks = |(name, ground): (&String, &GroundTable)| {
        let slopes = up_to(ground.friction_angle_deg.reckoned());
        format!(
            "{name}: a block by its shape; on a face, if it does not tip, it stays {slopes}, the friction angle"
        )
    };
    let of_spheres = scene.grounds.iter().filter(|_| scene.has_spheres()).map(spheres);
    let of_blocks = scene.grounds.iter().filter(|_| scene.has_blocks()).map(blocks);
    of_spheres.chain(of_blocks).collect()
}

/// What each ground gives back of the slip of an impact that sticks, at its median values.
pub(super) fn tangential(scene: &Scene) -> Vec<String> {
    let answer = |(name, ground): (&String, &GroundTable)| {
        let normal_n_m = ground.normal_stiffness_n_m.quantile(0.5);
        let ratio = ground.shear_n_m(normal_n_m, |value| value.quantile(0.5)) / normal_n_m;
        let restitution = ground.restitution.as_ref().map(|e| e.quantile(0.5));
        let back = restitution.map_or_else(String::new, |e| {
            let back = tangential_restitution(ratio, &Damping::of(Some(e)));
            format!(", tangential restitution {back:.3} where an impact sticks")
        });
        format!("{name}: shear over normal spring {ratio:.4}{back}")
    };
    scene.grounds.iter().map(answer).collect()
}

/// Warns of grounds of the catalogue under a slope on which nothing stops a sphere.
fn endless_rolling(scene: &Scene) -> impl Iterator<Item = String> {
    let lies = |name: &str| scene.terrain.iter().any(|mesh| mesh.ground == name);
    scene.grounds.iter().filter_map(move |(name, ground)| {
        let known = known_ground(ground.like.as_deref()?)?;
        let is_endless = ground.rolling_friction.is_none() && lies(name) && scene.has_spheres();
        is_endless.then(|| {
            format!(
                "[grounds.{name}] like {}: its source has no rolling friction, and without any nothing stops a sphere that rolls; write rolling_friction",
                known.name
            )
        })
    })
}

/// Warns of rolling friction beside shapes: what was fitted to spheres holds blocks back twice.
fn rolling_of_blocks(scene: &Scene) -> impl Iterator<Item = String> {
    let rolls = scene.grounds.iter();
    let rolls = rolls.filter(|(_, ground)| can_exceed_0(ground.rolling_friction.as_ref()));
    rolls.filter(|_| scene.has_blocks()).map(|(name, _)| {
        format!(
            "[grounds.{name}] rolling_friction acts on blocks beside their shape, which already holds them back as they roll: keep only what soft ground takes; a value that was fitted to spheres counts the shape twice"
        )
    })
}

/// What the scene warns of that no part of the plan does: grounds, and what all rocks share.
pub(super) fn warnings(scene: &Scene, terrain: &Terrain) -> Vec<String> {
    let of_terrain = [unused(scene, terrain), trees::astray(terrain)].concat();
    [slips::of(scene, terrain.epsg), of_terrain, apart::warnings(scene)].concat()
}

/// Warnings about grounds and keys that nothing answers with.
fn unused(scene: &Scene, terrain: &Terrain) -> Vec<String> {
    let used = |index: usize| terrain.sheets.iter().any(|sheet| usize::from(sheet.ground) == index);
    let has_tree = |index: usize| {
        terrain.sheets.iter().any(|sheet| sheet.is_tree && usize::from(sheet.ground) == index)
    };
    let wrong = |(index, (name, ground)): (usize, (&String, &GroundTable))| {
        if !used(index) {
            Some(format!("[grounds.{name}] lies under no mesh"))
        } else if ground.breaks_above_j.is_some() && !has_tree(index) {
            Some(format!("[grounds.{name}] has breaks_above_j, but no tree: only trees give way"))
        } else {
            None
        }
    };
    let wrong = scene.grounds.iter().enumerate().filter_map(wrong);
    wrong.chain(endless_rolling(scene)).chain(rolling_of_blocks(scene)).collect()
}

/// Triangles of trees; none where there is no tree.
pub(super) fn tree_triangles(terrain: &Terrain) -> Option<usize> {
    let trees = (0..terrain.triangles.len() as u32).filter(|&triangle| terrain.is_tree(triangle));
    Some(trees.count()).filter(|count| *count > 0)
}

/// How rocks answer each other.
pub(super) fn between_rocks(scene: &Scene) -> Option<Ground> {
    scene.rocks.contact.as_ref().map(|contact| {
        let springs = [contact.normal_stiffness_n_m, contact.shear_stiffness_n_m];
        Ground::smooth(springs, contact.friction_angle_deg.to_radians(), contact.restitution)
    })
}

/// Bonds between the rocks of one world.
pub(super) fn bonds(scene: &Scene) -> Part<BondStrength> {
    let Some(contact) = scene.rocks.contact.as_ref().filter(|_| scene.release.together) else {
        return Part::LeftOut("releases are independent");
    };
    if !scene.solver.scheme().has_springs() {
        return Part::LeftOut("a bond breaks by its springs, and the rigid limit has none");
    }
    let strength =
        BondStrength { tensile_pa: contact.tensile_strength_pa, cohesion_pa: contact.cohesion_pa };
    Part::when(
        strength.is_some().then_some(strength),
        "neither tensile_strength_pa nor cohesion_pa is above 0",
    )
}

/// Speed of the impact by which a scar is described (m/s).
const SQUARE_M_S: f64 = 10.0;

/// What soft soil does, ground by ground; none where all are hard.
pub(super) fn soil(scene: &Scene) -> Option<Vec<String>> {
    let radius_m = scene.rocks.radius_m().quantile(0.5);
    let median = Rock { radius_m, density_kg_m3: scene.rocks.density_kg_m3 };
    let mut lines = Vec::new();
    for (name, ground) in &scene.grounds {
        let slips = ground.slip_friction.map(|slip| {
            let least = math::tan(ground.friction_angle_deg.quantile(0.5).to_radians());
            format!("{name}: friction grows with slip, from {least:.3} to {}", slip.most)
        });
        let digs = ground.scar.map(|scar| format!("{name}: {}", dug(&scar, &median)));
        let falls = ground.restitution_half_speed_m_s.as_ref().map(|half| {
            let half_m_s = half.quantile(0.5);
            format!("{name}: half of the restitution is left at {half_m_s:.3} m/s")
        });
        lines.extend([slips, digs, falls].into_iter().flatten());
    }
    (!lines.is_empty()).then_some(lines)
}

/// What a scar does to a rock that falls square on the ground.
fn dug(scar: &Scar, rock: &Rock) -> String {
    let depth_m = scar.depth_m(rock.mass_kg(), SQUARE_M_S);
    let swept = swept_m3(rock.radius_m, depth_m, 1.0);
    let lost = 1.0 - math::exp(-scar.drag_per_m3(rock.mass_kg()) * swept);
    format!(
        "the median rock that falls on it at {SQUARE_M_S} m/s digs in {depth_m:.3} m and loses {:.1} % of its speed on the way",
        100.0 * lost
    )
}
