//! Stems that give way: which triangles of the trees belong to one stem, and how much it can take.

use super::Terrain;
use super::stem_pieces::stem_groups;
use crate::random::Distribution;
use crate::rock::Vec3;

/// No stem, or one that stands for good.
const NONE: u32 = u32::MAX;

/// The stems that can give way, numbered from 0 in the order of their lowest vertices.
#[derive(Debug)]
pub struct Stems {
    /// Stem of every triangle of the terrain.
    of_triangle: Vec<u32>,
    /// Ground of every stem.
    grounds: Vec<u16>,
    /// What a stem of each ground can take (J); none = it stands for good.
    pub limits_j: Vec<Option<Distribution>>,
}

impl Stems {
    /// Finds the stems of the trees whose ground has a limit: what hangs together by common vertices is one, with what stands on it or
    /// in it. None if there are none.
    ///
    /// # Errors
    /// Where such a stem shares a vertex with something that stays (m, local): its end would leave a hole in that.
    pub fn of(
        terrain: &Terrain,
        limits_j: Vec<Option<Distribution>>,
    ) -> Result<Option<Self>, Vec3> {
        let ground = |t: usize| terrain.sheets[usize::from(terrain.sheet_of[t])].ground;
        let breaks =
            |t: usize| terrain.is_tree(t as u32) && limits_j[usize::from(ground(t))].is_some();
        let count = terrain.triangles.len();
        if !(0..count).any(breaks) {
            return Ok(None);
        }
        let breaking: Vec<u32> =
            (0..count).filter(|&t| breaks(t)).map(|triangle| triangle as u32).collect();
        let mut groups = stem_groups(terrain, &breaking);
        let mut in_stem = vec![false; terrain.vertices_m.len()];
        for vertex in breaking.iter().flat_map(|&t| terrain.triangles[t as usize]) {
            in_stem[vertex as usize] = true;
        }
        let staying = (0..count).filter(|&t| !breaks(t)).flat_map(|t| terrain.triangles[t]);
        if let Some(shared) = staying.into_iter().find(|&vertex| in_stem[vertex as usize]) {
            return Err(terrain.vertices_m[shared as usize]);
        }
        let (mut of_triangle, mut grounds) = (vec![NONE; count], Vec::new());
        let mut number_of = vec![NONE; terrain.vertices_m.len()];
        for t in (0..count).filter(|&t| breaks(t)) {
            let number = &mut number_of[groups.lowest(terrain.triangles[t][0]) as usize];
            if *number == NONE {
                *number = grounds.len() as u32;
                grounds.push(ground(t));
            }
            of_triangle[t] = *number;
        }
        Ok(Some(Self { of_triangle, grounds, limits_j }))
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.grounds.len()
    }

    /// The stem of a triangle, if it can give way.
    #[inline]
    pub fn of_triangle(&self, triangle: u32) -> Option<u32> {
        Some(self.of_triangle[triangle as usize]).filter(|&stem| stem != NONE)
    }

    /// Index of the ground that a stem belongs to.
    pub fn ground_of(&self, stem: u32) -> usize {
        usize::from(self.grounds[stem as usize])
    }
}

impl Terrain {
    /// Whether a triangle belongs to one of the stems that are gone.
    #[inline]
    pub fn is_gone(&self, triangle: u32, gone: &[u32]) -> bool {
        !gone.is_empty() && self.is_of_stems(triangle, gone)
    }

    #[cold]
    fn is_of_stems(&self, triangle: u32, gone: &[u32]) -> bool {
        let stem = self.stems.as_ref().and_then(|stems| stems.of_triangle(triangle));
        stem.is_some_and(|stem| gone.contains(&stem))
    }
}
