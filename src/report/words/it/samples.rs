//! What is said of samples of rocks and of lines in English, in Italian.

/// By patterns, as for the plan.
pub(super) const SAMPLES: &[(&str, &str)] = &[
    (
        "rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share, as how long a heap moves: run several seeds and compare",
        "i blocchi di uno stesso mondo si incontrano: tutti gli intervalli li considerano indipendenti e sono troppo stretti per ciò che hanno in comune, come la durata del moto di un cumulo; calcolare con più semi (seed) e confrontare",
    ),
    (
        "rocks differ up to {a} times in mass and contacts up to {b} times in stiffness: where the product is more than {c} blows through several contacts are taken one by one, and a boulder on a light stone comes off too slowly; write stiffnesses that are nearer to each other, or scheme = \"adaptive\"",
        "i blocchi differiscono fino a {a} volte in massa e i contatti fino a {b} volte in rigidezza: dove il prodotto supera {c} gli urti attraverso più contatti sono presi uno a uno, e un masso su una pietra leggera rimbalza troppo lentamente; scrivere rigidezze più vicine, oppure scheme = \"adaptive\"",
    ),
    (
        "line “{name}”: its pieces from corner {a} and corner {b} cross; a rock counts once, where it crosses first. Write the corners in order if the line is not meant so",
        "linea “{name}”: i suoi tratti dai vertici {a} e {b} si incrociano; un blocco conta una volta, dove la attraversa per primo. Scrivere i vertici in ordine se la linea non è voluta così",
    ),
    (
        "line “{name}”: {a} of its {b} m have no ground below; what comes there is not computed, and its numbers hold for the rest",
        "linea “{name}”: sotto {a} dei suoi {b} m manca il terreno; ciò che vi arriva non è calcolato, i suoi valori valgono per il resto",
    ),
    (
        "{file}: cells that stand more than {m} m above or below all around them: {n}, the first at ({x}, {y}); errors of measurement, or trees and masts? rocks meet them as ground",
        "{file}: celle a più di {m} m sopra o sotto tutte quelle attorno: {n}, la prima in ({x}, {y}); errori di misura, o alberi e pali? i blocchi le incontrano come suolo",
    ),
    (
        "[[objects]] without [frequency]: how many releases hit them is computed, how often a year and at what risk is not",
        "[[objects]] senza [frequency]: quanti distacchi li colpiscono è calcolato, quante volte all’anno e con quale rischio no",
    ),
    (
        "{a} {kind_a} of memory, and about {b} {kind_b} of disk ({files}): {n} release, up to {p} points of paths, {c} cells of maps",
        "{a} {kind_a} di memoria, e circa {b} {kind_b} di disco ({files}): {n} distacco, fino a {p} punti di traiettorie, {c} celle di mappe",
    ),
    (
        "kept for {k} of {n} release, every {t} s",
        "conservate per {k} {k|distacco|distacchi} su {n}, ogni {t} s",
    ),
    ("from one point", "da un solo punto"),
    ("{a} m long, {b} m wide", "lungo {a} m, largo {b} m"),
    ("{name}: {a} a year of {b} m³, {rest}", "{name}: {a} all’anno di {b} m³, {rest}"),
    ("{name}: {a} a year of {b} m³", "{name}: {a} all’anno di {b} m³"),
    ("{a} a year of {b} m³, {rest}", "{a} all’anno di {b} m³, {rest}"),
    ("{a} a year of {b} m³", "{a} all’anno di {b} m³"),
    (
        "A name in quotation marks alone stands for the rocks that the barriers of each run have let through to that place: at a barrier those that arrive at it. Those that pass it are a share of all releases.",
        "Un nome da solo fra virgolette indica i massi che le barriere di ogni calcolo hanno lasciato passare fin lì: a una barriera, quelli che vi arrivano. Quelli che la superano sono una percentuale di tutti i distacchi.",
    ),
    (
        "islands of rocks that may touch, each with its own step; heaps of more than {n} that touch go on as with rigid where none is struck hard: what a spring does within a blow is left out there",
        "isole di massi che possono toccarsi, ciascuna con il suo passo; i cumuli di più di {n} che si toccano continuano come con rigid finché nessuno è colpito forte: ciò che fa una molla durante un urto vi è tralasciato",
    ),
    (
        "{n} of {tried} releases tried out lie on the line “{name}” before they move: they do not cross it by that, and count only where they come back over it. Draw the line or the release elsewhere",
        "{n} dei {tried} distacchi provati si trovano sulla linea “{name}” prima di muoversi: non la attraversano per questo e contano solo dove vi ripassano. Disegnare altrove la linea o il distacco",
    ),
    ("left open", "resta aperto"),
    (
        "TEK17 § 7-3: more often than the safety classes S3 (1), S2 (2), S1 (3) permit",
        "TEK17 § 7-3: più spesso di quanto permettano le classi di sicurezza S3 (1), S2 (2), S1 (3)",
    ),
    // Families of distributions, and units of memory, in places named after them
    ("[uniform]", "uniforme"),
    ("[normal]", "normale"),
    ("[lognormal]", "lognormale"),
    ("[triangular]", "triangolare"),
    ("[listed values]", "da un elenco"),
    ("[fixed]", "fisso"),
    ("[MB]", "MB"),
    ("[GB]", "GB"),
    (
        "Direktoratet for byggkvalitet, Byggteknisk forskrift (TEK17) § 7-3, table of the second paragraph: largest nominal annual probability S1 1/100, S2 1/1000, S3 1/5000",
        "Direktoratet for byggkvalitet, Byggteknisk forskrift (TEK17) § 7-3, tabella del secondo comma: massima probabilità annua nominale S1 1/100, S2 1/1000, S3 1/5000",
    ),
    (
        "The design energy {e} {unit} is that of the design block of {v} m³ ({m} kg without factors) at P{p} of speed, {s} m/s without factors.",
        "L’energia di progetto {e} {unit} è quella del blocco di progetto di {v} m³ ({m} kg senza fattori) al P{p} della velocità, {s} m/s senza fattori.",
    ),
    (
        "The design energy is P{p} of total energy with the squares of the factors on speed; the standard has that of its design block at P{q} of speed, which block_volume_m3 asks for.",
        "L’energia di progetto è il P{p} dell’energia totale con i quadrati dei fattori sulla velocità; la norma prende quella del suo blocco di progetto al P{q} della velocità, che block_volume_m3 richiede.",
    ),
    (
        "The capacity must be {f} times that, {e} {unit}.",
        "La capacità deve esserne {f} volte, {e} {unit}.",
    ),
    (
        "The standard's factor on the energy of the barrier is not applied: its value is yours, capacity_factor takes it.",
        "Il fattore della norma sull’energia della barriera non è applicato: il suo valore spetta al progettista, capacity_factor lo riceve.",
    ),
];
