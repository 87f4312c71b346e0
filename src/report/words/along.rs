//! What is said of a few rocks along their ways beside all of them, and of lines along a profile, language by language.

use super::year::words_of;

words_of! {
    AlongWords:
    percentiles, log_scale, unnamed,
}

const EN: AlongWords = AlongWords {
    percentiles: " Grey lines: median and P95 of the largest values of all {rocks}; one in twenty goes beyond P95.",
    log_scale: " The scale of energy is logarithmic, as the largest energies of these rocks differ by a factor of {ratio}; below {least} {unit} nothing is drawn.",
    unnamed: " Without room for their names, from left to right: {names}.",
};

const DE: AlongWords = AlongWords {
    percentiles: " Graue Linien: Median und P95 der Größtwerte aller {rocks}; einer von zwanzig liegt über P95.",
    log_scale: " Die Skala der Energie ist logarithmisch, da sich die größten Energien dieser Blöcke um einen Faktor {ratio} unterscheiden; unter {least} {unit} ist nichts gezeichnet.",
    unnamed: " Ohne Platz für ihre Namen, von links nach rechts: {names}.",
};

const FR: AlongWords = AlongWords {
    percentiles: " Lignes grises\u{a0}: médiane et P95 des plus grandes valeurs des {rocks}\u{a0}; un sur vingt dépasse P95.",
    log_scale: " L’échelle de l’énergie est logarithmique, car les plus grandes énergies de ces blocs diffèrent d’un facteur {ratio}\u{a0}; sous {least} {unit} rien n’est dessiné.",
    unnamed: " Sans place pour leurs noms, de gauche à droite\u{a0}: {names}.",
};

const IT: AlongWords = AlongWords {
    percentiles: " Linee grigie: mediana e P95 dei valori massimi di tutti i {rocks}; uno su venti supera P95.",
    log_scale: " La scala dell’energia è logaritmica, perché le energie massime di questi massi differiscono di un fattore {ratio}; sotto {least} {unit} non si disegna nulla.",
    unnamed: " Senza spazio per i nomi, da sinistra a destra: {names}.",
};
