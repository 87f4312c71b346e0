//! The surface by which a block is drawn: its rounded hull with edges and corners cut flat.

use super::Shape;
use super::solid::Surface;
use std::collections::BTreeMap;

/// A face of the core and one of its corners, both by number.
type CornerOfFace = (usize, u8);

impl Shape {
    /// The closed surface through the points where the faces of the rounded hull end: each face in
    /// its place, a strip for each edge, a polygon for each corner. All of it is inside the rounded
    /// hull, nowhere deeper than the radius of the balls.
    pub fn cut_surface(&self) -> Surface {
        let faces = &self.core.faces;
        let mut number: BTreeMap<CornerOfFace, u32> = BTreeMap::new();
        let mut surface = Surface::default();
        for (f, face) in faces.iter().enumerate() {
            for &k in &face.corners {
                number.insert((f, k), surface.points.len() as u32);
                surface.points.push(self.core.corners[usize::from(k)] + face.normal * self.ball);
            }
        }
        let mut polygon = |own: &[CornerOfFace]| {
            let [first, rest @ ..] = own else { return };
            let fan = rest.windows(2).map(|two| [*first, two[0], two[1]]);
            surface.triangles.extend(fan.map(|three| three.map(|own| number[&own])));
        };
        for (f, face) in faces.iter().enumerate() {
            polygon(&face.corners.iter().map(|&k| (f, k)).collect::<Vec<_>>());
        }
        let sides = self.sides();
        for (&(a, b), &f) in sides.iter().filter(|((a, b), _)| a < b) {
            let g = sides[&(b, a)];
            polygon(&[(f, b), (f, a), (g, a), (g, b)]);
        }
        for k in 0..self.core.corners.len() as u8 {
            polygon(&self.around(k, &sides));
        }
        surface
    }

    /// The face on the left of each directed edge, as seen from outside.
    fn sides(&self) -> BTreeMap<(u8, u8), usize> {
        let mut sides = BTreeMap::new();
        for (f, face) in self.core.faces.iter().enumerate() {
            let ends = face.corners.iter().skip(1).chain(face.corners.first());
            sides.extend(face.corners.iter().zip(ends).map(|(&a, &b)| ((a, b), f)));
        }
        sides
    }

    /// The faces at a corner in order, as seen from outside.
    fn around(&self, corner: u8, sides: &BTreeMap<(u8, u8), usize>) -> Vec<CornerOfFace> {
        let next = |f: usize| {
            let own = &self.core.faces[f].corners;
            let at = own.iter().position(|&k| k == corner)?;
            let before = own[(at + own.len() - 1) % own.len()];
            sides.get(&(corner, before)).copied()
        };
        let first = sides.range((corner, 0)..=(corner, u8::MAX)).next().map(|(_, &f)| f);
        let mut found: Vec<CornerOfFace> = Vec::new();
        let mut face = first;
        while let Some(f) = face.filter(|&f| !found.contains(&(f, corner))) {
            found.push((f, corner));
            face = next(f);
        }
        found
    }
}
