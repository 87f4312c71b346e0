//! How the numbers came about, language by language.

use super::year::words_of;

words_of! {
    MethodWords:
    spheres, shapes, slope, slope_and_trees, springs, rigid, alone, one_world, counted, scheme,
}

const EN: MethodWords = MethodWords {
    spheres: "Each rock is a homogeneous sphere that falls, bounces, slides and rolls over {meshes}: flights are exact parabolas, and a contact belongs to one face, edge or corner, so that seams between triangles are not felt.",
    shapes: "Each rock is a homogeneous sphere or a rounded convex block that falls, bounces, slides and rolls over {meshes}: centres fly on exact parabolas, blocks turn freely in closed form, and a contact belongs to one face, edge or corner, so that seams between triangles are not felt.",
    slope: "the triangle mesh of the slope",
    slope_and_trees: "the triangle meshes of slope and trees",
    springs: "Contacts follow spherical discontinuous deformation analysis: springs normal and along the surface, limited by Coulomb friction, with damping that gives the stated restitution and an optional rolling friction.",
    rigid: "Contacts follow spherical discontinuous deformation analysis in the limit of stiff springs: an impact takes no time, the rock rebounds by the stated restitution and rubs within Coulomb friction; sliding and rolling are held without penetration, with an optional rolling friction.",
    alone: "Every rock is a function of scene, seed and its number alone: the same alone, among all others, and on any number of threads.",
    one_world: "All rocks share one world and strike each other: together they are a function of scene and seed, the same on any number of threads.",
    counted: "All rocks are counted, those that failed or left the terrain too, and every estimate stands beside its confidence interval.",
    scheme: "Scheme in force: {scheme}.",
};

const DE: MethodWords = MethodWords {
    spheres: "Jeder Block ist eine homogene Kugel, die über {meshes} fällt, springt, gleitet und rollt: Flüge sind exakte Parabeln, und ein Kontakt gehört zu einer Fläche, Kante oder Ecke, so dass Nähte zwischen Dreiecken nicht spürbar sind.",
    shapes: "Jeder Block ist eine homogene Kugel oder ein gerundeter konvexer Körper, der über {meshes} fällt, springt, gleitet und rollt: Mittelpunkte fliegen auf exakten Parabeln, Körper drehen sich frei in geschlossener Form, und ein Kontakt gehört zu einer Fläche, Kante oder Ecke, so dass Nähte zwischen Dreiecken nicht spürbar sind.",
    slope: "das Dreiecksnetz des Hanges",
    slope_and_trees: "die Dreiecksnetze von Hang und Bäumen",
    springs: "Kontakte folgen der sphärischen diskontinuierlichen Deformationsanalyse (SDDA): Federn rechtwinklig zur und entlang der Oberfläche, begrenzt durch Coulombsche Reibung, mit einer Dämpfung, die den angegebenen Rückprallkoeffizienten ergibt, und wahlweise Rollreibung.",
    rigid: "Kontakte folgen der sphärischen diskontinuierlichen Deformationsanalyse (SDDA) im Grenzfall steifer Federn: Ein Aufprall dauert keine Zeit, der Block prallt mit dem angegebenen Rückprallkoeffizienten zurück und reibt innerhalb der Coulombschen Grenze; Gleiten und Rollen werden ohne Eindringung gehalten, wahlweise mit Rollreibung.",
    alone: "Jeder Block ist allein eine Funktion von Szene, Startwert und seiner Nummer: derselbe allein, unter allen anderen und auf beliebig vielen Rechenkernen.",
    one_world: "Alle Blöcke teilen eine Welt und stoßen aneinander: Zusammen sind sie eine Funktion von Szene und Startwert, dieselben auf beliebig vielen Rechenkernen.",
    counted: "Alle Blöcke werden gezählt, auch fehlgeschlagene und solche, die das Gelände verließen, und jeder Schätzwert steht neben seinem Vertrauensintervall.",
    scheme: "Angewandtes Verfahren: {scheme}.",
};

const FR: MethodWords = MethodWords {
    spheres: "Chaque bloc est une sphère homogène qui tombe, rebondit, glisse et roule sur {meshes}\u{a0}: les vols sont des paraboles exactes, et un contact appartient à une face, une arête ou un sommet, de sorte que les joints entre triangles ne se sentent pas.",
    shapes: "Chaque bloc est une sphère homogène ou un corps convexe arrondi qui tombe, rebondit, glisse et roule sur {meshes}\u{a0}: les centres volent sur des paraboles exactes, les corps tournent librement sous forme close, et un contact appartient à une face, une arête ou un sommet, de sorte que les joints entre triangles ne se sentent pas.",
    slope: "le maillage triangulaire du versant",
    slope_and_trees: "les maillages triangulaires du versant et des arbres",
    springs: "Les contacts suivent l’analyse sphérique des déformations discontinues (SDDA)\u{a0}: ressorts normaux et tangentiels, limités par le frottement de Coulomb, avec un amortissement qui donne la restitution indiquée et, en option, un frottement de roulement.",
    rigid: "Les contacts suivent l’analyse sphérique des déformations discontinues (SDDA) à la limite des ressorts raides\u{a0}: un impact ne prend aucun temps, le bloc rebondit selon la restitution indiquée et frotte dans les limites de Coulomb\u{a0}; glissement et roulement sont maintenus sans pénétration, avec en option un frottement de roulement.",
    alone: "Chaque bloc est fonction de la scène, de la graine et de son seul numéro\u{a0}: le même seul, parmi tous les autres et sur n’importe quel nombre de processeurs.",
    one_world: "Tous les blocs partagent un même monde et se heurtent entre eux\u{a0}: ensemble ils sont fonction de la scène et de la graine, les mêmes sur n’importe quel nombre de processeurs.",
    counted: "Tous les blocs sont comptés, y compris ceux en échec ou sortis du terrain, et chaque estimation est accompagnée de son intervalle de confiance.",
    scheme: "Schéma appliqué\u{a0}: {scheme}.",
};

const IT: MethodWords = MethodWords {
    spheres: "Ogni masso è una sfera omogenea che cade, rimbalza, scivola e rotola {meshes}: i voli sono parabole esatte e un contatto appartiene a una faccia, uno spigolo o un vertice, così che le giunzioni fra triangoli non si sentono.",
    shapes: "Ogni masso è una sfera omogenea o un corpo convesso arrotondato che cade, rimbalza, scivola e rotola {meshes}: i centri volano su parabole esatte, i corpi ruotano liberamente in forma chiusa, e un contatto appartiene a una faccia, uno spigolo o un vertice, così che le giunzioni fra triangoli non si sentono.",
    slope: "sulla maglia triangolare del versante",
    slope_and_trees: "sulle maglie triangolari del versante e degli alberi",
    springs: "I contatti seguono l’analisi sferica delle deformazioni discontinue (SDDA): molle normali e tangenziali, limitate dall’attrito di Coulomb, con uno smorzamento che dà la restituzione indicata e, facoltativo, un attrito volvente.",
    rigid: "I contatti seguono l’analisi sferica delle deformazioni discontinue (SDDA) al limite delle molle rigide: un urto non dura alcun tempo, il masso rimbalza secondo la restituzione indicata e striscia entro l’attrito di Coulomb; scivolamento e rotolamento avvengono senza penetrazione, con un attrito volvente facoltativo.",
    alone: "Ogni masso è funzione della scena, del seme e del solo suo numero: lo stesso da solo, fra tutti gli altri e su qualsiasi numero di processori.",
    one_world: "Tutti i massi condividono un solo mondo e si urtano fra loro: insieme sono funzione della scena e del seme, gli stessi su qualsiasi numero di processori.",
    counted: "Tutti i massi sono contati, anche quelli falliti o usciti dal terreno, e ogni stima sta accanto al suo intervallo di confidenza.",
    scheme: "Schema applicato: {scheme}.",
};
