//! What is said in keys and captions only where it applies, language by language.

use super::year::words_of;

words_of! {
    DrawnWords:
    key_object, per_square, aside, sources, reach_open, profile_marks, beyond, ends_worth,
    ends_no_test, nobody_untold, outside, plan_no_paths, not_judged, not_judged_why,
    quantile_lines, swiss_limits, weaker, runout_no_curve, rough,
}

const EN: DrawnWords = DrawnWords {
    key_object: "object",
    per_square: ": from {classes} in ({side} m)²",
    aside: " {n} of these paths {n|leads|lead} more than {degrees}° away from this direction: seen from this side {n|it is shortened and looks steeper than it is|they are shortened and look steeper than they are}.",
    sources: " All sources ({n}) stand in one view and in one colour; the map tells them apart.",
    reach_open: " {n} {n|rock|rocks} left the terrain, {n|was|were} still moving or failed and would have gone on: {n|its angle is|theirs is} an upper bound.",
    profile_marks: " Lines and barriers stand at the median distance at which rocks cross them.",
    beyond: " “+n →”: so many rocks lie beyond the end of the axis.",
    ends_worth: " The limit is that of {worth} independent ends: throws of one block are alike, and the {ends} measured ends are worth no more.",
    ends_no_test: " Where values of the scene were fitted to these same ends, it is no test of them.",
    nobody_untold: "No rock of {n} crosses {what} {name}; of so few its reach probability cannot be told: it may be up to {share}.",
    outside: " Outside the frame: {names}.",
    plan_no_paths: "Plan view in map coordinates, at equal scale. No path of the {releases} {releases|release|releases} is stored.",
    not_judged: "not judged",
    not_judged_why: "; most rocks would have gone on: too early to tell",
    quantile_lines: " Lines: P50 full, P95 dashed, P99 dotted.",
    swiss_limits: " The Swiss limits of intensity are marked.",
    weaker: "← {n} with less energy",
    runout_no_curve: "Horizontal distance from release to end. Above: no curve, as rocks that would have gone on decide it from its beginning. Below: share of releases per {width} m.",
    rough: " Changes with ln(rate) and exponent are derivatives without an interval, rough to two digits.",
};

const DE: DrawnWords = DrawnWords {
    key_object: "Objekt",
    per_square: ": je ({side} m)² ab {classes}",
    aside: " {n} dieser Bahnen {n|führt|führen} um mehr als {degrees}° von dieser Richtung weg: von dieser Seite gesehen {n|ist sie verkürzt und wirkt steiler, als sie ist|sind sie verkürzt und wirken steiler, als sie sind}.",
    sources: " Alle Quellen ({n}) stehen in einer Ansicht und in einer Farbe; der Lageplan hält sie auseinander.",
    reach_open: " {n} {n|Block verließ|Blöcke verließen} das Gelände, {n|bewegte|bewegten} sich noch oder {n|schlug|schlugen} fehl und {n|wäre|wären} weitergelaufen: {n|sein|ihr} Wert ist eine obere Schranke.",
    profile_marks: " Linien und Werke stehen im mittleren Abstand (Median), in dem Blöcke sie queren.",
    beyond: " „+n →“: so viele Blöcke liegen jenseits der Achse.",
    ends_worth: " Die Grenze gilt für {worth} unabhängige Endpunkte: Würfe desselben Blocks gleichen sich, und die {ends} gemessenen Endpunkte sind nicht mehr wert.",
    ends_no_test: " Wo Werte der Szene an eben diese Endpunkte angepasst wurden, prüft sie diese nicht.",
    nobody_untold: "Keiner von {n} Blöcken überquert {what} {name}; bei so wenigen ist die Erreichenswahrscheinlichkeit nicht bestimmt: bis {share} ist möglich.",
    outside: " Außerhalb des Ausschnitts: {names}.",
    plan_no_paths: "Lageplan in Landeskoordinaten, maßstäblich. Von den {releases} Ablösungen ist keine Bahn gespeichert.",
    not_judged: "nicht beurteilt",
    not_judged_why: "; die meisten Blöcke wären weitergelaufen: noch nicht zu beurteilen",
    quantile_lines: " Linien: P50 voll, P95 gestrichelt, P99 punktiert.",
    swiss_limits: " Die Schweizer Grenzen der Intensität sind markiert.",
    weaker: "← {n} mit weniger Energie",
    runout_no_curve: "Horizontale Strecke von der Ablösung bis zum Ende. Oben: keine Kurve, da Blöcke, die weitergelaufen wären, sie von Anfang an bestimmen. Unten: Anteil der Ablösungen je {width} m.",
    rough: " Änderungen mit ln(Rate) und Exponent sind Ableitungen ohne Intervall, grob auf zwei Stellen.",
};

const FR: DrawnWords = DrawnWords {
    key_object: "objet",
    per_square: "\u{a0}: par ({side} m)², dès {classes}",
    aside: " {n} de ces trajectoires {n|s’écarte|s’écartent} de plus de {degrees}° de cette direction\u{a0}: {n|vue de ce côté elle est raccourcie et paraît plus raide qu’elle n’est|vues de ce côté elles sont raccourcies et paraissent plus raides qu’elles ne sont}.",
    sources: " Toutes les sources ({n}) figurent dans une seule vue et d’une seule couleur\u{a0}; la vue en plan les distingue.",
    reach_open: " {n} {n|bloc est sorti|blocs sont sortis} du terrain, {n|bougeait encore ou a échoué et aurait|bougeaient encore ou ont échoué et auraient} continué\u{a0}: {n|son|leur} angle est une borne supérieure.",
    profile_marks: " Lignes et ouvrages sont à la distance médiane à laquelle les blocs les franchissent.",
    beyond: " «\u{a0}+n →\u{a0}»\u{a0}: nombre de blocs au-delà de l’axe.",
    ends_worth: " La limite vaut pour {worth} points d’arrêt indépendants\u{a0}: les jets d’un même bloc se ressemblent, et les {ends} points mesurés n’en valent pas plus.",
    ends_no_test: " Là où des valeurs de la scène ont été ajustées à ces mêmes points, elle n’en est pas un test.",
    nobody_untold: "Aucun bloc sur {n} ne franchit {what} {name}\u{a0}; avec si peu de blocs la probabilité d’atteinte reste indéterminée, jusqu’à {share}.",
    outside: " Hors du cadre\u{a0}: {names}.",
    plan_no_paths: "Vue en plan en coordonnées de carte, à l’échelle. Aucune trajectoire des {releases} départs n’est enregistrée.",
    not_judged: "non jugé",
    not_judged_why: "\u{a0}; la plupart des blocs auraient continué\u{a0}: trop tôt pour juger",
    quantile_lines: " Traits\u{a0}: P50 plein, P95 tirets, P99 pointillé.",
    swiss_limits: " Les limites suisses d’intensité sont marquées.",
    weaker: "← {n} d’énergie moindre",
    runout_no_curve: "Distance horizontale du départ à l’arrêt. En haut\u{a0}: pas de courbe, car des blocs qui auraient continué la déterminent dès son début. En bas\u{a0}: part des départs par {width} m.",
    rough: " Les variations avec ln(taux) et exposant sont des dérivées sans intervalle, approximatives, à deux chiffres.",
};

const IT: DrawnWords = DrawnWords {
    key_object: "oggetto",
    per_square: ": per ({side} m)², da {classes}",
    aside: " {n} di queste traiettorie {n|si scosta|si scostano} di più di {degrees}° da questa direzione: {n|vista da questo lato è accorciata e sembra più ripida di quanto sia|viste da questo lato sono accorciate e sembrano più ripide di quanto siano}.",
    sources: " Tutte le sorgenti ({n}) stanno in una sola vista e in un solo colore; la pianta le distingue.",
    reach_open: " {n} {n|masso è uscito|massi sono usciti} dal terreno, {n|era|erano} ancora in moto o {n|è fallito e avrebbe|sono falliti e avrebbero} proseguito: il {n|suo|loro} è un limite superiore.",
    profile_marks: " Linee e barriere stanno alla distanza mediana a cui i massi le attraversano.",
    beyond: " «+n →»: massi oltre la fine dell’asse.",
    ends_worth: " Il limite vale per {worth} punti di arresto indipendenti: i lanci dello stesso masso si somigliano, e i {ends} punti misurati non valgono di più.",
    ends_no_test: " Dove valori della scena sono stati adattati a questi stessi punti, non ne è una verifica.",
    nobody_untold: "Nessuno di {n} massi attraversa {what} {name}; con così pochi la probabilità di raggiungimento resta indeterminata, fino a {share}.",
    outside: " Fuori dal riquadro: {names}.",
    plan_no_paths: "Planimetria in coordinate cartografiche, in scala. Nessuna traiettoria dei {releases} distacchi è salvata.",
    not_judged: "non giudicato",
    not_judged_why: "; la maggior parte dei massi avrebbe proseguito: troppo presto per giudicare",
    quantile_lines: " Linee: P50 piena, P95 tratteggiata, P99 punteggiata.",
    swiss_limits: " Sono segnati i limiti svizzeri di intensità.",
    weaker: "← {n} con meno energia",
    runout_no_curve: "Distanza orizzontale dal distacco all’arresto. Sopra: nessuna curva, perché massi che avrebbero proseguito la determinano fin dall’inizio. Sotto: quota dei distacchi per {width} m.",
    rough: " Le variazioni con ln(tasso) ed esponente sono derivate senza intervallo, approssimate a due cifre.",
};
