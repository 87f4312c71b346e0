//! What the grounds of a scene ask of the plan: stems that give way, sources of values, grounds without use.

use crate::error::{Error, Result};
use crate::ground::{Damping, Ground, tangential_restitution};
use crate::math;
use crate::release::NO_WIDTH_M;
use crate::scene::{GroundTable, Scene, known_ground};
use crate::terrain::Terrain;
use crate::terrain::stems::Stems;

/// Grounds with values of the catalogue: name, what was taken, source.
pub(super) fn catalogued(scene: &Scene) -> Vec<String> {
    let taken = |(name, ground): (&String, &GroundTable)| {
        let known = known_ground(ground.like.as_deref()?)?;
        Some(format!(
            "{name} like {}: {} unless written in the scene; {}",
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

/// Refuses meshes so small that nothing can fall on them: their unit is another, most likely.
pub(super) fn check_size(scene: &Scene, terrain: &Terrain) -> Result<()> {
    let (low, high) = terrain.index.bounds();
    let size_m = (high - low).max();
    if size_m >= NO_WIDTH_M {
        return Ok(());
    }
    let found = format!("found meshes of {size_m:.1e} m in all");
    let remedy = "write scale = metres in one unit of the file";
    Err(Error::input(&scene.file, "[[terrain]] scale", found, remedy))
}

/// The steepest slope on which each ground stops a rolling sphere: `tan θ` = rolling friction.
pub(super) fn rolling_stops(scene: &Scene) -> Vec<String> {
    let stops = |(name, ground): (&String, &GroundTable)| {
        let Some(rolling) = ground.rolling_friction.as_ref() else {
            return format!("{name}: on no slope, it has no rolling friction");
        };
        let [least, middle, most] = rolling.reckoned().map(|value| math::atan(value).to_degrees());
        let spread =
            if most > least { format!(" ({least:.1}° to {most:.1}°)") } else { String::new() };
        format!("{name}: on slopes of up to {middle:.1}°{spread}")
    };
    scene.grounds.iter().map(stops).collect()
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
        (ground.rolling_friction.is_none() && lies(name)).then(|| {
            format!(
                "[grounds.{name}] like {}: its source has no rolling friction, and without any nothing stops a sphere that rolls; write rolling_friction",
                known.name
            )
        })
    })
}

/// Warnings about grounds and keys that nothing answers with.
pub(super) fn unused(scene: &Scene, terrain: &Terrain) -> Vec<String> {
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
    scene.grounds.iter().enumerate().filter_map(wrong).chain(endless_rolling(scene)).collect()
}

/// Triangles of trees; none where there is no tree.
pub(super) fn tree_triangles(terrain: &Terrain) -> Option<usize> {
    let trees = (0..terrain.triangles.len() as u32).filter(|&triangle| terrain.is_tree(triangle));
    Some(trees.count()).filter(|count| *count > 0)
}

/// How rocks answer each other.
pub(super) fn between_rocks(scene: &Scene) -> Option<Ground> {
    scene.rocks.contact.as_ref().map(|contact| Ground {
        normal_stiffness_n_m: contact.normal_stiffness_n_m,
        shear_stiffness_n_m: contact.shear_stiffness_n_m,
        friction_angle_rad: contact.friction_angle_deg.to_radians(),
        restitution: contact.restitution,
        rolling_friction: 0.0,
        roughness_rad: 0.0,
        roughness_length_m: None,
        slip_friction: None,
    })
}
