//! What is said of rocks that would have gone on and of what they do to the numbers, language by language.

use super::year::words_of;
use super::{fill, format};
use crate::hazard::Proportion;

words_of! {
    OpenWords:
    some_rocks, censored, largest_left, largest_open, largest_closed, have_left, remedy_left, remedy_holes, have_no_time, remedy_time, have_failed, have_no_budget,
    remedy_budget, at_line, on_maps, median, no_sampling,
    at_ends,
}

/// So many of the rocks, beside a place or map where they are missing: `text` is one of the texts for it; nothing of none.
pub(in crate::report) fn missing(text: &str, rocks: Option<&Proportion>) -> String {
    let said = |of: &Proportion| {
        let share = format::percent_of_part(of.share, usize::from(of.share < 0.1));
        fill(text, &[("n", &format::decimal(of.count as f64, 0)), ("share", &share)])
    };
    rocks.map_or(String::new(), said)
}

const EN: OpenWords = OpenWords {
    some_rocks: "{n} of {of} rocks ({share})",
    censored: "{rocks} {what}: their runout is a lower and their reach angle an upper bound, and so is every percentile that they decide (≥, ≤; its interval holds however they would have gone on, and has no end on that side where they are too many). Shares and frequencies at lines that they may still come to are lower bounds too; the upper ends of their intervals count these rocks as arriving. {largest} {remedy}",
    largest_left: "Their largest energies, speeds and heights and their impacts are those on the terrain.",
    largest_open: "Their largest energies, speeds and heights and their impacts are lower bounds too.",
    largest_closed: "What they have left of energy, their fall to the lowest ground with it, makes none of their largest energies, speeds and heights larger; their impacts are lower bounds.",
    have_left: "left the terrain",
    remedy_left: "Give terrain that reaches farther if they matter.",
    remedy_holes: "At holes in the mesh {n} of them left, most near ({x}, {y}): fill the holes.",
    have_no_time: "{n|was still moving when its|were still moving when their} time was up",
    remedy_time: "Give a longer [solver] longest_s.",
    have_failed: "failed",
    have_no_budget: "{n|was still moving when its|were still moving when their} budget of work was spent",
    remedy_budget: "Ask why: see how the rocks ended.",
    at_line: " Rocks that may still come here, with any energy and height: {n} ({share}). The values are of those that came, and percentiles may be too low or too high.",
    on_maps: " Rocks that ended on the map and would have gone on: {n} ({share}); their time or work was up, the computation failed, or they left the terrain away from the edge of the map. Further on they are missing, and probabilities and percentiles may be too low.",
    median: "The median is at most {median}°: rocks that would have gone on leave open how much less it is.",
    no_sampling: "no sampling error: only a bound, {n} of {of} rocks would have gone on",
    at_ends: " Of {of} computed rocks {n} ({share}) had not ended: {left} left the terrain, {moving} {moving|was|were} still moving. They are taken as far as they were seen: however they would have ended, mean runout, KS and area are at least what is said (≥), and the scatter is that of these places.",
};

const DE: OpenWords = OpenWords {
    some_rocks: "{n} von {of} Blöcken ({share})",
    censored: "{rocks} {what}: ihre Auslaufstrecke ist eine untere und ihr Pauschalgefälle eine obere Schranke, ebenso jedes Perzentil, das von ihnen abhängt (≥, ≤; sein Intervall gilt, wie auch immer sie weitergelaufen wären, und hat auf dieser Seite kein Ende, wenn es zu viele sind). Auch Anteile und Häufigkeiten an Linien, zu denen sie noch kommen können, sind untere Schranken; die oberen Enden der Intervalle zählen diese Blöcke als angekommen. {largest} {remedy}",
    largest_left: "Ihre größten Energien, Geschwindigkeiten und Höhen und ihre Aufpralle sind die auf dem Gelände.",
    largest_open: "Auch ihre größten Energien, Geschwindigkeiten und Höhen und ihre Aufpralle sind untere Schranken.",
    largest_closed: "Was sie noch an Energie haben, mit ihrem Fall bis zum tiefsten Boden, vergrößert keine ihrer größten Energien, Geschwindigkeiten und Höhen; ihre Aufpralle sind untere Schranken.",
    have_left: "{n|hat|haben} das Gelände verlassen",
    remedy_left: "Weiter reichendes Gelände angeben, falls sie zählen.",
    remedy_holes: "An Löchern im Netz {n|verließ|verließen} {n} von ihnen das Gelände, die meisten bei ({x}, {y}): die Löcher füllen.",
    have_no_time: "{n|bewegte sich noch, als seine|bewegten sich noch, als ihre} Zeit abgelaufen war",
    remedy_time: "Ein längeres [solver] longest_s angeben.",
    have_failed: "{n|ist|sind} fehlgeschlagen",
    have_no_budget: "{n|bewegte sich noch, als sein|bewegten sich noch, als ihr} Rechenaufwand erschöpft war",
    remedy_budget: "Dem nachgehen: siehe, wie die Blöcke endeten.",
    at_line: " Blöcke, die noch hierher kommen können, mit beliebiger Energie und Höhe: {n} ({share}). Die Werte sind die der angekommenen, und Perzentile können zu niedrig oder zu hoch sein.",
    on_maps: " Blöcke, die auf der Karte endeten und weitergelaufen wären: {n} ({share}); ihre Zeit oder ihr Rechenaufwand war erschöpft, die Rechnung schlug fehl, oder sie verließen das Gelände abseits vom Kartenrand. Weiter unten fehlen sie, und Wahrscheinlichkeiten und Perzentile können zu niedrig sein.",
    median: "Der Median ist höchstens {median}°: Blöcke, die weitergelaufen wären, lassen offen, um wie viel er kleiner ist.",
    no_sampling: "kein Stichprobenfehler: nur eine Schranke, {n} von {of} Blöcken wären weitergelaufen",
    at_ends: " Von {of} berechneten Blöcken {n|war|waren} {n} ({share}) nicht am Ende: {left} {left|hat|haben} das Gelände verlassen, {moving} {moving|bewegte|bewegten} sich noch. Sie gelten, soweit sie gesehen wurden: wie auch immer sie geendet hätten, sind mittlere Auslaufstrecke, KS und Fläche mindestens die genannten (≥), und die Streuung ist die dieser Orte.",
};

const FR: OpenWords = OpenWords {
    some_rocks: "{n} {n|bloc|bloc|blocs} sur {of} ({share})",
    censored: "{rocks} {what}\u{a0}: leur distance est une borne inférieure et leur angle d’énergie une borne supérieure, comme tout centile qui en dépend (≥, ≤\u{a0}; son intervalle vaut quelle qu’eût été leur suite, et n’a pas de fin de ce côté s’ils sont trop nombreux). Les parts et les fréquences aux lignes qu’ils peuvent encore atteindre sont aussi des bornes inférieures\u{a0}; le haut de leurs intervalles compte ces blocs comme arrivés. {largest} {remedy}",
    largest_left: "Leurs énergies, vitesses et hauteurs maximales et leurs impacts sont ceux sur le terrain.",
    largest_open: "Leurs énergies, vitesses et hauteurs maximales et leurs impacts sont aussi des bornes inférieures.",
    largest_closed: "Ce qui leur reste d’énergie, avec leur chute jusqu’au sol le plus bas, n’augmente aucune de leurs énergies, vitesses et hauteurs maximales\u{a0}; leurs impacts sont des bornes inférieures.",
    have_left: "{n|est sorti|sont sortis} du terrain",
    remedy_left: "Donner un terrain plus étendu s’ils importent.",
    remedy_holes: "Aux trous du maillage, {n} d’entre eux {n|est sorti|sont sortis}, la plupart près de ({x}, {y})\u{a0}: combler les trous.",
    have_no_time: "{n|bougeait encore à la fin de son|bougeaient encore à la fin de leur} temps",
    remedy_time: "Donner un [solver] longest_s plus long.",
    have_failed: "{n|a|ont} échoué",
    have_no_budget: "{n|bougeait encore quand son|bougeaient encore quand leur} budget de calcul fut épuisé",
    remedy_budget: "En chercher la cause\u{a0}: voir comment finissent les blocs.",
    at_line: " Blocs qui peuvent encore venir ici, avec toute énergie et toute hauteur\u{a0}: {n} ({share}). Les valeurs sont celles des blocs arrivés, et les centiles peuvent être trop faibles ou trop élevés.",
    on_maps: " Blocs arrêtés sur la carte qui auraient continué\u{a0}: {n} ({share})\u{a0}; leur temps ou leur budget de calcul était épuisé, le calcul a échoué, ou ils ont quitté le terrain loin du bord de la carte. Plus loin ils manquent, et probabilités et centiles peuvent être trop faibles.",
    median: "La médiane est d’au plus {median}°\u{a0}: les blocs qui auraient continué laissent ouvert de combien elle est inférieure.",
    no_sampling: "pas d’erreur d’échantillonnage\u{a0}: seulement une borne, {n} blocs sur {of} auraient continué",
    at_ends: " Sur {of} blocs calculés, {n} ({share}) {n|n’était pas arrivé|n’étaient pas arrivés}\u{a0}: {left} {left|est sorti|sont sortis} du terrain, {moving} {moving|bougeait|bougeaient} encore. Ils comptent là où ils ont été vus\u{a0}: quel qu’eût été leur arrêt, distance moyenne, KS et aire valent au moins ce qui est dit (≥), et la dispersion est celle de ces lieux.",
};

const IT: OpenWords = OpenWords {
    some_rocks: "{n} {n|masso|massi} su {of} ({share})",
    censored: "{rocks} {what}: la loro distanza è un limite inferiore e il loro angolo un limite superiore, come ogni percentile che ne dipende (≥, ≤; il suo intervallo vale comunque avessero proseguito, e non ha estremo da quel lato se sono troppi). Anche percentuali e frequenze alle linee che possono ancora raggiungere sono limiti inferiori; l’estremo superiore dei loro intervalli conta questi massi come arrivati. {largest} {remedy}",
    largest_left: "Le loro energie, velocità e altezze massime e i loro impatti sono quelli sul terreno.",
    largest_open: "Anche le loro energie, velocità e altezze massime e i loro impatti sono limiti inferiori.",
    largest_closed: "L’energia che resta loro, con la caduta fino al suolo più basso, non aumenta nessuna delle loro energie, velocità e altezze massime; i loro impatti sono limiti inferiori.",
    have_left: "{n|è uscito|sono usciti} dal terreno",
    remedy_left: "Fornire un terreno più esteso se contano.",
    remedy_holes: "Ai buchi della maglia {n} di essi {n|è uscito|sono usciti}, la maggior parte presso ({x}, {y}): chiudere i buchi.",
    have_no_time: "{n|era|erano} ancora in moto allo scadere del tempo",
    remedy_time: "Dare un [solver] longest_s più lungo.",
    have_failed: "{n|è fallito|sono falliti}",
    have_no_budget: "{n|era|erano} ancora in moto quando lo sforzo di calcolo fu esaurito",
    remedy_budget: "Chiedersi perché: vedere come finiscono i massi.",
    at_line: " Massi che possono ancora giungere qui, con qualsiasi energia e altezza: {n} ({share}). I valori sono quelli dei massi arrivati, e i percentili possono essere troppo bassi o troppo alti.",
    on_maps: " Massi finiti sulla carta che avrebbero proseguito: {n} ({share}); il loro tempo o lo sforzo di calcolo era esaurito, il calcolo è fallito, o hanno lasciato il terreno lontano dal bordo della carta. Più oltre mancano, e probabilità e percentili possono essere troppo bassi.",
    median: "La mediana è al più {median}°: i massi che avrebbero proseguito lasciano aperto di quanto sia inferiore.",
    no_sampling: "nessun errore di campionamento: solo un limite, {n} massi su {of} avrebbero proseguito",
    at_ends: " Di {of} massi calcolati, {n} ({share}) non {n|era giunto|erano giunti} alla fine: {left} {left|è uscito|sono usciti} dal terreno, {moving} {moving|era|erano} ancora in moto. Valgono fin dove sono stati visti: comunque fossero finiti, distanza media, KS e area sono almeno quanto detto (≥), e la dispersione è quella di questi luoghi.",
};

#[cfg(test)]
mod tests {
    use super::super::Words;
    use crate::scene::Language;

    /// A bound has an interval where few rocks would have gone on: no text says that it has none.
    #[test]
    fn a_bound_may_have_an_interval() {
        let denied = [
            "no interval",
            "kein Intervall",
            "d’intervalle",
            "sans intervalle",
            "nessun intervallo",
        ];
        for language in Language::ALL {
            let words = Words::of(language);
            let bound = words.glossary.iter().find(|(term, _)| term.starts_with('≥'));
            let texts = [words.open().censored, bound.map_or("", |(_, meaning)| meaning)];
            for text in texts {
                assert!(text.to_lowercase().contains("interval"), "{text}");
                assert!(!denied.iter().any(|no| text.contains(no)), "{text}");
            }
        }
    }
}
