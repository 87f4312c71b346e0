//! Ground and trees of a terrain apart.

use crate::terrain::Terrain;

/// Triangles with their own corners, map coordinates (m).
#[derive(Debug, Clone, Default)]
pub(super) struct TriangleSoup {
    pub(super) places_m: Vec<[f64; 3]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Ground or trees of a terrain in the order of their files: neighbours of a grid stand side by side there. Large terrains
/// are looked at where they are: a copy would not fit beside them.
#[derive(Debug)]
pub(super) struct TerrainPart<'a> {
    terrain: &'a Terrain,
    /// Its triangles.
    order: Vec<u32>,
    /// Numbers of the terrain's vertices in the part, in the order in which triangles first use them.
    number: Vec<u32>,
    /// The vertices by that number.
    used: Vec<u32>,
}

impl<'a> TerrainPart<'a> {
    pub(super) fn of(terrain: &'a Terrain, trees: bool) -> Self {
        let own = |t: &u32| terrain.is_tree(*t) == trees;
        let mut order: Vec<u32> = (0..terrain.triangles.len() as u32).filter(own).collect();
        let key = |t: u32| (terrain.sheet_of[t as usize], terrain.facet_of[t as usize], t);
        order.sort_unstable_by_key(|&t| key(t));
        let vertices = if order.is_empty() { 0 } else { terrain.vertices_m.len() };
        let (mut number, mut used) = (vec![u32::MAX; vertices], Vec::new());
        for vertex in order.iter().flat_map(|&t| terrain.triangles[t as usize]) {
            let number = &mut number[vertex as usize];
            if *number == u32::MAX {
                *number = used.len() as u32;
                used.push(vertex);
            }
        }
        Self { terrain, order, number, used }
    }

    /// How many triangles it has.
    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    /// How many vertices it has.
    pub(super) fn vertices(&self) -> usize {
        self.used.len()
    }

    /// Place of a vertex, map coordinates (m).
    pub(super) fn place_m(&self, vertex: u32) -> [f64; 3] {
        let local_m = self.terrain.vertices_m[self.used[vertex as usize] as usize];
        (local_m + self.terrain.origin_m).into()
    }

    /// Corners of its triangles.
    pub(super) fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let corners = |&t: &u32| self.terrain.triangles[t as usize];
        self.order.iter().map(corners).map(|corners| corners.map(|v| self.number[v as usize]))
    }

    /// A copy of its own.
    pub(super) fn soup(&self) -> TriangleSoup {
        let places_m = (0..self.used.len() as u32).map(|vertex| self.place_m(vertex)).collect();
        TriangleSoup { places_m, triangles: self.triangles().collect() }
    }
}
