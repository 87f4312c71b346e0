//! What is said in keys and captions only where it applies, language by language.

use super::year::words_of;

words_of! {
    DrawnWords:
    key_object, per_square, aside, sources, reach_open, profile_marks, beyond,
}

const EN: DrawnWords = DrawnWords {
    key_object: "object",
    per_square: ": from {classes} in a square",
    aside: " {n} of these paths lead more than {degrees}° away from this direction: seen from this side they are shortened and look steeper than they are.",
    sources: " All {n} sources stand in one view and in one colour; the map tells them apart.",
    reach_open: " {n} rocks left the terrain, were still moving or failed and would have gone on: theirs is an upper bound.",
    profile_marks: " Lines and barriers stand at the median distance at which rocks cross them.",
    beyond: " “+n →”: so many rocks lie beyond the end of the axis.",
};

const DE: DrawnWords = DrawnWords {
    key_object: "Objekt",
    per_square: ": je Quadrat ab {classes}",
    aside: " {n} dieser Bahnen führen um mehr als {degrees}° von dieser Richtung weg: von dieser Seite gesehen sind sie verkürzt und wirken steiler, als sie sind.",
    sources: " Alle {n} Quellen stehen in einer Ansicht und in einer Farbe; der Lageplan hält sie auseinander.",
    reach_open: " {n} Blöcke verließen das Gelände, bewegten sich noch oder schlugen fehl und wären weitergelaufen: ihr Wert ist eine obere Schranke.",
    profile_marks: " Linien und Werke stehen im mittleren Abstand (Median), in dem Blöcke sie queren.",
    beyond: " „+n →“: so viele Blöcke liegen jenseits der Achse.",
};

const FR: DrawnWords = DrawnWords {
    key_object: "objet",
    per_square: "\u{a0}: par carré, dès {classes}",
    aside: " {n} de ces trajectoires s’écartent de plus de {degrees}° de cette direction\u{a0}: vues de ce côté elles sont raccourcies et paraissent plus raides qu’elles ne sont.",
    sources: " Les {n} sources figurent toutes dans une seule vue et d’une seule couleur\u{a0}; la vue en plan les distingue.",
    reach_open: " {n} blocs sont sortis du terrain, bougeaient encore ou ont échoué et auraient continué\u{a0}: leur angle est une borne supérieure.",
    profile_marks: " Lignes et ouvrages sont à la distance médiane à laquelle les blocs les franchissent.",
    beyond: " «\u{a0}+n →\u{a0}»\u{a0}: nombre de blocs au-delà de l’axe.",
};

const IT: DrawnWords = DrawnWords {
    key_object: "oggetto",
    per_square: ": per quadrato, da {classes}",
    aside: " {n} di queste traiettorie si scostano di più di {degrees}° da questa direzione: viste da questo lato sono accorciate e sembrano più ripide di quanto siano.",
    sources: " Tutte le {n} sorgenti stanno in una sola vista e in un solo colore; la pianta le distingue.",
    reach_open: " {n} massi sono usciti dal terreno, erano ancora in moto o sono falliti e avrebbero proseguito: il loro è un limite superiore.",
    profile_marks: " Linee e barriere stanno alla distanza mediana a cui i massi le attraversano.",
    beyond: " «+n →»: massi oltre la fine dell’asse.",
};
