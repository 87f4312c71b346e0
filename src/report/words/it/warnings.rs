//! What plan and run warn of in English, in Italian.

/// By patterns, as for the plan.
pub(super) const WARNINGS: &[(&str, &str)] = &[
    ("[grounds.{name}] lies under no mesh", "[grounds.{name}] non è sotto nessuna mesh"),
    (
        "[grounds.{name}] has breaks_above_j, but no tree: only trees give way",
        "[grounds.{name}] ha breaks_above_j, ma nessun albero: solo gli alberi cedono",
    ),
    (
        "[grounds.{name}] like {known}: its source has no rolling friction, and without any nothing stops a sphere that rolls; write rolling_friction",
        "[grounds.{name}] like {known}: la sua fonte non ha attrito di rotolamento, e senza nulla ferma una sfera che rotola; scrivere rolling_friction",
    ),
    (
        "capture_speed_m_s = {a} is below half the tolerance of {b} m/s: slow rocks may flutter and never come to rest; write {c} or more",
        "capture_speed_m_s = {a} è sotto la metà della tolleranza di {b} m/s: massi lenti possono vibrare senza mai fermarsi; scrivere {c} o più",
    ),
    (
        "{where} omega * step_s = {x} for a rock of {r} m, which is thrown back within one step, the livelier the longer the step: write a step_s below {y}",
        "{where} omega * step_s = {x} per un masso di {r} m, che è rigettato in un solo passo, tanto più vivacemente quanto più lungo è il passo: scrivere uno step_s sotto {y}",
    ),
    (
        "step_s = {a} lets a rock fall for {b} s at most before its budget of {c} steps is spent; write a longer step, or a longest_s below that",
        "step_s = {a} lascia cadere un masso al massimo {b} s prima che il suo budget di {c} passi sia esaurito; scrivere un passo più lungo, o un longest_s più breve",
    ),
    (
        "{a} % of the places drawn for {n} releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain): such a place is drawn again",
        "{a} % dei luoghi estratti per {n} distacchi non ha suolo o spazio per il masso (un buco, un albero, il bordo del terreno): un tale luogo è estratto di nuovo",
    ),
    (
        "{a} of {n} releases tried out find no place to start from: each has a row with the stop reason not_released and counts in no statistic",
        "{a} distacchi su {n} provati non trovano un luogo da cui partire: ognuno ha una riga con la fine not_released e non conta in nessuna statistica",
    ),
    (
        "{n} releases over {k} classes of size and source: with fewer than {few} each the intervals a year may be too narrow; write count = {c} or more",
        "{n} distacchi su {k} classi di dimensione e sorgente: con meno di {few} per classe gli intervalli all’anno possono essere troppo stretti; scrivere count = {c} o più",
    ),
    ("no ground below", "nessun suolo sotto"),
    ("in the ground or a tree", "nel suolo o in un albero"),
    ("1/year", "1/a"),
    (
        "{who}: the rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share: a change that is clear here may be chance. Run several seeds of each scene and compare.",
        "{who}: i massi di uno stesso mondo si incontrano, ma tutti gli intervalli li considerano indipendenti e sono troppo stretti per ciò che hanno in comune: una variazione qui significativa può essere caso. Calcolare con più semi (seed) di ogni scena e confrontare.",
    ),
    (
        "{file} says how large the rocks of its zones are, which is not used: sizes are those of the scene; where each zone says how often too, and [frequency] has no law of its own, each has its own",
        "{file} dice quanto sono grandi i massi delle sue zone, e non è usato: le dimensioni sono quelle della scena; dove ogni zona dice anche quanto spesso, e [frequency] non ha una legge propria, ognuna ha le sue",
    ),
    (
        "in the fit on all {n} of {of} computed rocks ({share} %) had not ended, {left} had left the terrain, {moving} were still moving: mean runouts and shares are at least what is said, KS distances and intervals hold however these rocks would have ended; write {what}",
        "nella calibrazione su tutti, {n} massi calcolati su {of} ({share} %) non erano giunti alla fine, {left} erano usciti dal terreno, {moving} erano ancora in moto: le distanze medie e le quote valgono almeno quanto detto, le distanze KS e gli intervalli valgono comunque questi massi fossero finiti; scrivere {what}",
    ),
    (
        "{name}: rocks that had not ended leave open which values fit best, as far as to the lower end of the range tried, {a}; write a longer longest_s or a larger terrain before a smaller from in vary",
        "{name}: massi non giunti alla fine lasciano aperto quali valori si adattino meglio, fino all’estremo inferiore dell’intervallo provato, {a}; scrivere un longest_s più lungo o un terreno più esteso prima di un from più piccolo in vary",
    ),
    (
        "{name}: rocks that had not ended leave open which values fit best, as far as to the upper end of the range tried, {a}; write a longer longest_s or a larger terrain before a larger to in vary",
        "{name}: massi non giunti alla fine lasciano aperto quali valori si adattino meglio, fino all’estremo superiore dell’intervallo provato, {a}; scrivere un longest_s più lungo o un terreno più esteso prima di un to più grande in vary",
    ),
    ("a larger terrain", "un terreno più esteso"),
    ("a longer longest_s", "un longest_s più lungo"),
    ("a longer longest_s and a larger terrain", "un longest_s più lungo e un terreno più esteso"),
    (
        "{name}: the values that fit best reach the lower end of the range tried, {a}, and better ones may lie below it; write a smaller from in vary",
        "{name}: i valori che si adattano meglio arrivano all’estremo inferiore dell’intervallo provato, {a}, e valori migliori possono trovarsi al di sotto; scrivere in vary un from più piccolo",
    ),
    (
        "{name}: the values that fit best reach the upper end of the range tried, {a}, and better ones may lie above it; write a larger to in vary",
        "{name}: i valori che si adattano meglio arrivano all’estremo superiore dell’intervallo provato, {a}, e valori migliori possono trovarsi al di sopra; scrivere in vary un to più grande",
    ),
    (
        "the values tried do not explain the measured ends: KS distance {a} of the fit on all, 5 % limit {b}; write wider ranges in vary, vary other values, or look at terrain, rocks and releases",
        "i valori provati non spiegano gli arresti misurati: distanza KS {a} dell’adattamento su tutti, limite al 5 % {b}; scrivere in vary intervalli più ampi, variare altri valori, o rivedere terreno, blocchi e distacchi",
    ),
    (
        "{file}: {n} of {of} stems do not stand on the slope: {a} with their foot more than 0.5 m above it, {b} with their top under it, {c} beside it; rocks meet them in the wrong place or not at all. Export the file in the coordinates and heights of the terrain, or look at its scale and up",
        "{file}: {n} fusti su {of} non stanno sul pendio: {a} con il piede più di 0.5 m al di sopra, {b} con la cima al di sotto, {c} a lato; i massi li incontrano nel posto sbagliato o per nulla. Esportare il file nelle coordinate e quote del terreno, o rivedere scale e up",
    ),
    (
        "trees: none of {n} rocks touched one; do they stand where the rocks come?",
        "alberi: nessuno dei {n} massi ne ha toccato uno; stanno dove arrivano i massi?",
    ),
    (
        "{file}: its map coordinates are written in steps of {a}, {b} % of the median edge {c}, and {n} of its {m} facets have no area: where they were rounded, slopes are wrong; export it with three decimals or more, or with a map origin subtracted and origin_m in the scene",
        "{file}: le sue coordinate sono scritte a passi di {a}, {b} % dello spigolo mediano {c}, e {n} dei suoi {m} triangoli sono senza area: dove sono state arrotondate, le pendenze sono sbagliate; esportarlo con tre o più decimali, o con un’origine sottratta e origin_m nella scena",
    ),
    (
        "{file}: its map coordinates are written in steps of {a}, {b} % of the median edge {c}: where they were rounded, slopes are wrong; export it with three decimals or more, or with a map origin subtracted and origin_m in the scene",
        "{file}: le sue coordinate sono scritte a passi di {a}, {b} % dello spigolo mediano {c}: dove sono state arrotondate, le pendenze sono sbagliate; esportarlo con tre o più decimali, o con un’origine sottratta e origin_m nella scena",
    ),
    (
        "{n} of {all} triangles have no area and are left out: what is left is hardly the terrain; does the file have too few digits?",
        "{n} triangoli su {all} sono senza area e tralasciati: ciò che resta è a stento il terreno; il file ha troppo poche cifre?",
    ),
    (
        "{file}: properties that are not used: {names}; zones have {known}",
        "{file}: proprietà che non sono usate: {names}; le zone hanno {known}",
    ),
    (
        "{a} % of the places drawn for {n} releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain; {b} % on ground so steep that no height is clear of it): such a place is drawn again",
        "{a} % dei luoghi estratti per {n} distacchi non ha suolo o spazio per il masso (un buco, un albero, il bordo del terreno; {b} % su suolo così ripido che nessuna altezza ne è libera): un tale luogo è estratto di nuovo",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is higher than any net; is it in cm? write {b}",
        "[[barriers]] \"{name}\" height_m = {a} è più alto di ogni rete; in cm? scrivere {b}",
    ),
    (
        "[[barriers]] \"{name}\" height_m = {a} is higher than any net; the tallest in use have about 10 m",
        "[[barriers]] \"{name}\" height_m = {a} è più alto di ogni rete; le più alte in uso hanno circa 10 m",
    ),
    (
        "{file}: {n} of {of} stems are left out, as no ground lies below them, the first in line {row} at ({x}, {y}): beside the slope as it is cropped, or over a hole. Where they should stand, look at crop, at the coordinates of the list and at holes of the slope",
        "{file}: {n} fusti su {of} sono tralasciati, perché sotto di essi non c’è suolo, il primo alla riga {row} in ({x}, {y}): a lato del pendio così come è ritagliato, o sopra un buco. Dove dovrebbero stare, rivedere crop, le coordinate della lista e i buchi del pendio",
    ),
    (
        "{file}: {n} of {of} stems are left out, as no ground lies below them, the first as feature {row} at ({x}, {y}): beside the slope as it is cropped, or over a hole. Where they should stand, look at crop, at the coordinates of the list and at holes of the slope",
        "{file}: {n} fusti su {of} sono tralasciati, perché sotto di essi non c’è suolo, il primo come oggetto {row} in ({x}, {y}): a lato del pendio così come è ritagliato, o sopra un buco. Dove dovrebbero stare, rivedere crop, le coordinate della lista e i buchi del pendio",
    ),
    (
        "{n} of {m} releases tried out start more than 100 m above the ground, up to {h} m: do the heights of the releases and of the slope belong together, with their sign?",
        "{n} distacchi provati su {m} iniziano a più di 100 m sopra il suolo, fino a {h} m: le quote dei distacchi e del pendio stanno insieme, con il loro segno?",
    ),
    (
        "none of {n} rocks touched the ground: do the places and heights of the releases belong to this slope?",
        "nessuno dei {n} massi ha toccato il suolo: i luoghi e le quote dei distacchi appartengono a questo pendio?",
    ),
    ("{line}: 0 of {n} rocks of {class}", "{line}: 0 massi su {n} di {class}"),
    (
        "holes in the slope: {n}, the largest of {a} m² near ({x}, {y}); rocks that come there leave the terrain: fill them",
        "buchi nel pendio: {n}, il più grande di {a} m² presso ({x}, {y}); i massi che vi arrivano escono dal terreno: chiuderli",
    ),
    (
        "single corners far above or below all around them: {n}, the farthest by {a} m at ({x}, {y}); errors of measurement, or trees and masts? rocks meet them as ground",
        "vertici isolati molto sopra o sotto tutto ciò che li circonda: {n}, il più lontano di {a} m in ({x}, {y}); errori di misura, o alberi e pali? i massi li toccano come suolo",
    ),
    (
        "sheets that hang above another part of the slope: {n}, the largest of {a} m², {b} m above it near ({x}, {y}); rocks meet them as ground: leave them out if they are none",
        "superfici sospese sopra un’altra parte del pendio: {n}, la più grande di {a} m², {b} m più in alto presso ({x}, {y}); i massi le toccano come suolo: toglierle se non lo sono",
    ),
];
