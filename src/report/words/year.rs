//! What is said of a year on the first page and on its maps, language by language.

/// A struct of texts, by name. Where it is called there is a constant of it for each language: `EN`, `DE`, `FR`, `IT`.
macro_rules! words_of {
    ($kind:ident: $($name:ident),+ $(,)?) => {
        /// The words of one language.
        #[derive(Debug)]
        pub(crate) struct $kind {
            $(pub(crate) $name: &'static str,)+
        }

        impl $kind {
            pub(super) fn of(language: $crate::scene::Language) -> &'static Self {
                use $crate::scene::Language;
                match language {
                    Language::En => &EN,
                    Language::De => &DE,
                    Language::Fr => &FR,
                    Language::It => &IT,
                }
            }

            /// All texts with places for what is found, by name.
            pub(super) fn texts(&self) -> Vec<(&'static str, &'static str)> {
                vec![$((stringify!($name), self.$name),)+]
            }
        }
    };
}

pub(super) use words_of;

words_of! {
    YearWords:
    head_title, head_note, head_exponent, head_row, maps_title, maps_alt, map_period, map_energy, map_by_exponent,
    map_level, maps_caption, maps_by_exponent, maps_level, weighed_needs,
}

const EN: YearWords = YearWords {
    head_title: "How often a year",
    head_note: "A year, not conditional on release. Small figures: 95 % intervals of chance in the sample; they do not say how well the law of the sources is known. 10 % more events a year at the sources change a number by 0.1 of its change with ln(rate){exponent}. The chapter on the year has all energies, the risks, and what each barrier keeps away.",
    head_exponent: ", an exponent larger by 0.1 by 0.1 of its change with exponent",
    head_row: "{name}: {energy} kJ or more{barriers}",
    maps_title: "A year on the map",
    maps_alt: "Maps of return period and energy",
    map_period: "Return period of {energy} kJ or more (years)",
    map_energy: "Energy of {years} years",
    map_by_exponent: "Change of ln(frequency) with exponent",
    map_level: "Level: {name}",
    maps_caption: "A year, not conditional on release, cell by cell and without barriers: return period of passages with {energy} kJ or more, and the energy that is passed once in {years} years (no colour: rocks come more seldom). 10 % more events a year at the sources make all frequencies 10 % larger.{exponent}{level} Intervals and derivatives of all layers lie in maps/ as GeoTIFF.",
    maps_by_exponent: " Change with exponent, of the same passages: 2 means 20 % more of them where the exponents of all power laws are 0.1 larger, their events of 1 m³ or more kept.",
    maps_level: " Levels by the table of the scene, “{name}”; its source: {source}.",
    weighed_needs: " Of rocks that differ in weight as many are needed as are worth 59 of equal weight.",
};

const DE: YearWords = YearWords {
    head_title: "Wie oft pro Jahr",
    head_note: "Pro Jahr, nicht bedingt auf die Ablösung. Kleine Zahlen: 95-%-Intervalle des Zufalls der Stichprobe; sie sagen nicht, wie gut das Gesetz der Quellen bekannt ist. 10 % mehr Ereignisse pro Jahr an den Quellen ändern eine Zahl um 0.1 ihrer Änderung mit ln(Rate){exponent}. Das Kapitel über das Jahr enthält alle Energien, die Risiken und was jedes Schutzbauwerk fernhält.",
    head_exponent: ", ein um 0.1 größerer Exponent um 0.1 ihrer Änderung mit dem Exponenten",
    head_row: "{name}: {energy} kJ oder mehr{barriers}",
    maps_title: "Das Jahr auf der Karte",
    maps_alt: "Karten von Wiederkehrperiode und Energie",
    map_period: "Wiederkehrperiode von ≥ {energy} kJ (Jahre)",
    map_energy: "Energie von {years} Jahren",
    map_by_exponent: "Änderung von ln(Häufigkeit) mit Exponent",
    map_level: "Stufe: {name}",
    maps_caption: "Pro Jahr, nicht bedingt auf die Ablösung, Zelle für Zelle und ohne Schutzbauwerke: Wiederkehrperiode der Durchgänge mit {energy} kJ oder mehr, und die Energie, die einmal in {years} Jahren überschritten wird (ohne Farbe: Blöcke kommen seltener). 10 % mehr Ereignisse pro Jahr an den Quellen machen alle Häufigkeiten 10 % größer.{exponent}{level} Intervalle und Ableitungen aller Ebenen liegen in maps/ als GeoTIFF.",
    maps_by_exponent: " Änderung derselben Durchgänge mit dem Exponenten: 2 heißt 20 % mehr, wenn die Exponenten aller Potenzgesetze um 0.1 größer sind und die Ereignisse ab 1 m³ bleiben.",
    maps_level: " Stufen nach der Tabelle der Szene, „{name}“; ihre Quelle: {source}.",
    weighed_needs: " Von Blöcken mit verschiedenem Gewicht braucht es so viele, wie 59 mit gleichem wert sind.",
};

const FR: YearWords = YearWords {
    head_title: "Combien de fois par an",
    head_note: "Par an, non conditionnel au départ. Petits chiffres\u{a0}: intervalles à 95 % de l’aléa de l’échantillon\u{a0}; ils ne disent pas si la loi des sources est bien connue. 10 % d’événements en plus par an aux sources changent un nombre de 0.1 de sa variation avec ln(taux){exponent}. Toutes les énergies, les risques et ce que chaque ouvrage évite sont au chapitre de l’année.",
    head_exponent: ", un exposant plus grand de 0.1 de 0.1 de sa variation avec l’exposant",
    head_row: "{name}\u{a0}: {energy} kJ ou plus{barriers}",
    maps_title: "L’année sur la carte",
    maps_alt: "Cartes de période de retour et d’énergie",
    map_period: "Période de retour de ≥ {energy} kJ (années)",
    map_energy: "Énergie de {years} ans",
    map_by_exponent: "Variation de ln(fréquence) avec l’exposant",
    map_level: "Degré\u{a0}: {name}",
    maps_caption: "Par an, non conditionnel au départ, maille par maille et sans ouvrages\u{a0}: période de retour des passages avec {energy} kJ ou plus, et énergie dépassée une fois en {years} ans (sans couleur\u{a0}: les blocs viennent plus rarement). 10 % d’événements en plus par an aux sources augmentent toutes les fréquences de 10 %.{exponent}{level} Intervalles et dérivées de toutes les couches sont dans maps/ en GeoTIFF.",
    maps_by_exponent: " Variation des mêmes passages avec l’exposant\u{a0}: 2 veut dire 20 % en plus si les exposants de toutes les lois de puissance sont plus grands de 0.1, leurs événements dès 1 m³ gardés.",
    maps_level: " Degrés selon la table de la scène, «\u{a0}{name}\u{a0}»\u{a0}; sa source\u{a0}: {source}.",
    weighed_needs: " De blocs de poids différents, il en faut autant qu’en valent 59 de poids égal.",
};

const IT: YearWords = YearWords {
    head_title: "Quante volte all’anno",
    head_note: "All’anno, non condizionato al distacco. Cifre piccole: intervalli al 95 % del caso nel campione; non dicono quanto bene sia nota la legge delle sorgenti. Il 10 % di eventi in più all’anno alle sorgenti cambia un numero di 0.1 della sua variazione con ln(tasso){exponent}. Tutte le energie, i rischi e ciò che ogni barriera evita sono nel capitolo dell’anno.",
    head_exponent: ", un esponente maggiore di 0.1 di 0.1 della sua variazione con l’esponente",
    head_row: "{name}: {energy} kJ o più{barriers}",
    maps_title: "L’anno sulla mappa",
    maps_alt: "Mappe di tempo di ritorno ed energia",
    map_period: "Tempo di ritorno di ≥ {energy} kJ (anni)",
    map_energy: "Energia di {years} anni",
    map_by_exponent: "Variazione di ln(frequenza) con l’esponente",
    map_level: "Grado: {name}",
    maps_caption: "All’anno, non condizionato al distacco, cella per cella e senza barriere: tempo di ritorno dei passaggi con {energy} kJ o più, ed energia superata una volta in {years} anni (senza colore: i massi arrivano più di rado). Il 10 % di eventi in più all’anno alle sorgenti rende tutte le frequenze maggiori del 10 %.{exponent}{level} Intervalli e derivate di tutti gli strati sono in maps/ come GeoTIFF.",
    maps_by_exponent: " Variazione degli stessi passaggi con l’esponente: 2 vuol dire il 20 % in più se gli esponenti di tutte le leggi di potenza sono maggiori di 0.1, mantenuti i loro eventi da 1 m³ in su.",
    maps_level: " Gradi secondo la tabella della scena, «{name}»; la sua fonte: {source}.",
    weighed_needs: " Di massi con pesi diversi ne servono tanti quanti ne valgono 59 di peso uguale.",
};
