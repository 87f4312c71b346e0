//! What is said of rocks with shapes, language by language.

use super::year::words_of;
use crate::body::ShapeKind;

words_of! {
    ShapeWords:
    shapes, turning, table_title, table_note, col_rocks, col_median, col_farthest,
    col_speed, col_energy, sphere, eota111, eota221, boxes, ellipsoid, prism, mesh,
}

impl ShapeWords {
    /// The name of a shape.
    pub(in crate::report) fn name(&self, kind: ShapeKind) -> &'static str {
        match kind {
            ShapeKind::Sphere => self.sphere,
            ShapeKind::Eota111 => self.eota111,
            ShapeKind::Eota221 => self.eota221,
            ShapeKind::Box => self.boxes,
            ShapeKind::Ellipsoid => self.ellipsoid,
            ShapeKind::Prism => self.prism,
            ShapeKind::Mesh => self.mesh,
        }
    }
}

const EN: ShapeWords = ShapeWords {
    shapes: "shapes: {names}",
    turning: "ω·Iω/2: I = 2/5 m R² of a sphere, of a block the moments of inertia of its shape.",
    table_title: "By shape",
    table_note: "Rocks of each kind of shape, with the sizes that were drawn for them. Small figures: 95 % intervals. Two kinds differ where their intervals lie apart; rockfall compare tells more of two runs.",
    col_rocks: "rocks",
    col_median: "median runout (m)",
    col_farthest: "runout, 95 % (m)",
    col_speed: "largest speed, 95 % (m/s)",
    col_energy: "total energy, 95 % ({unit})",
    sphere: "sphere",
    eota111: "EOTA 1:1:1",
    eota221: "EOTA 2:2:1",
    boxes: "box",
    ellipsoid: "ellipsoid",
    prism: "prism",
    mesh: "scan",
};

const DE: ShapeWords = ShapeWords {
    shapes: "Formen: {names}",
    turning: "ω·Iω/2: bei einer Kugel I = 2/5 m R², sonst die Trägheitsmomente der Form.",
    table_title: "Nach der Form",
    table_note: "Blöcke jeder Art von Form, mit den Größen, die für sie gezogen wurden. Kleine Zahlen: 95-%-Intervalle. Zwei Arten unterscheiden sich, wo ihre Intervalle auseinander liegen; mehr über zwei Läufe sagt rockfall compare.",
    col_rocks: "Blöcke",
    col_median: "Auslaufstrecke, Median (m)",
    col_farthest: "Auslaufstrecke, 95 % (m)",
    col_speed: "maximale Geschwindigkeit, 95 % (m/s)",
    col_energy: "Gesamtenergie, 95 % ({unit})",
    sphere: "Kugel",
    eota111: "EOTA 1:1:1",
    eota221: "EOTA 2:2:1",
    boxes: "Quader",
    ellipsoid: "Ellipsoid",
    prism: "Prisma",
    mesh: "Scan",
};

const FR: ShapeWords = ShapeWords {
    shapes: "formes\u{a0}: {names}",
    turning: "ω·Iω/2\u{a0}: I = 2/5 m R² pour une sphère, sinon les moments d’inertie de la forme.",
    table_title: "Selon la forme",
    table_note: "Blocs de chaque sorte de forme, avec les tailles tirées pour eux. Petits chiffres\u{a0}: intervalles à 95 %. Deux sortes diffèrent là où leurs intervalles sont disjoints\u{a0}; rockfall compare en dit plus sur deux calculs.",
    col_rocks: "blocs",
    col_median: "distance de propagation médiane (m)",
    col_farthest: "distance de propagation, 95 % (m)",
    col_speed: "vitesse maximale, 95 % (m/s)",
    col_energy: "énergie totale, 95 % ({unit})",
    sphere: "sphère",
    eota111: "EOTA 1:1:1",
    eota221: "EOTA 2:2:1",
    boxes: "parallélépipède",
    ellipsoid: "ellipsoïde",
    prism: "prisme",
    mesh: "relevé",
};

const IT: ShapeWords = ShapeWords {
    shapes: "forme: {names}",
    turning: "ω·Iω/2: I = 2/5 m R² per una sfera, altrimenti i momenti d’inerzia della forma.",
    table_title: "Secondo la forma",
    table_note: "Blocchi di ogni tipo di forma, con le dimensioni estratte per loro. Cifre piccole: intervalli al 95 %. Due tipi differiscono dove i loro intervalli sono disgiunti; rockfall compare dice di più su due calcoli.",
    col_rocks: "blocchi",
    col_median: "distanza di arresto mediana (m)",
    col_farthest: "distanza di arresto, 95 % (m)",
    col_speed: "velocità massima, 95 % (m/s)",
    col_energy: "energia totale, 95 % ({unit})",
    sphere: "sfera",
    eota111: "EOTA 1:1:1",
    eota221: "EOTA 2:2:1",
    boxes: "parallelepipedo",
    ellipsoid: "ellissoide",
    prism: "prisma",
    mesh: "rilievo",
};
