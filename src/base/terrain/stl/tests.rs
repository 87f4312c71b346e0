use super::*;
use proptest::prelude::*;

const TRIANGLE: &str = "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0.125\n \
                        endloop\nendfacet\n";

fn parse_text(text: impl AsRef<[u8]>) -> Result<Soup> {
    parse(text.as_ref().to_vec(), Path::new("t.stl"))
}

fn refusal(text: impl AsRef<[u8]>) -> String {
    parse_text(text).expect_err("must be refused").to_string()
}

fn corner() -> Facet {
    [Vec3::zeros(), Vec3::x(), Vec3::new(0.0, 1.0, 0.125)]
}

#[test]
fn text_reads_the_same_whatever_its_line_ends_case_and_blanks() {
    let plain = format!("solid a\n{TRIANGLE}endsolid a\n");
    for text in [
        plain.replace('\n', "\r\n"),
        plain.replace('\n', "\r"),
        plain.to_uppercase(),
        format!("\u{feff} \n\n{plain}\n\n"),
        plain.replace("endsolid a\n", "endsolid"),
        plain.replace(" a\n", "\n"),
        plain.replace("facet normal 0 0 1", "facet"),
        plain.replace("0 0 1", "nan -nan(ind) 1.#QNAN"),
    ] {
        assert_eq!(parse_text(&text).unwrap().facets, [corner()], "{text}");
    }
}

#[test]
fn every_solid_of_a_text_is_read_and_named() {
    let mut text = format!("solid upper part\n{TRIANGLE}endsolid upper part\n").into_bytes();
    text.extend_from_slice(b"solid B\xf6schung\n");
    text.extend_from_slice(format!("{TRIANGLE}endsolid").as_bytes());
    let soup = parse_text(text).unwrap();
    assert_eq!(soup.solids, ["upper part", "Böschung"]);
    assert_eq!(soup.facets, [corner(), corner()]);
}

#[test]
fn all_digits_of_map_coordinates_survive_text() {
    let text = format!(
        "solid a\n{}endsolid",
        TRIANGLE.replace("vertex 1 0 0", "vertex 2600000.123456789 1e39 0")
    );
    assert_eq!(
        parse_text(text).unwrap().facets.at(0)[1],
        Vec3::new(2_600_000.123_456_789, 1e39, 0.0)
    );
}

#[test]
fn a_refused_text_names_the_line_and_the_cure() {
    let with =
        |from: &str, to: &str| format!("solid a\n{}endsolid a\n", TRIANGLE.replacen(from, to, 1));
    let quad = with("  vertex 0 1 0.125\n", "  vertex 0 1 0.125\n  vertex 1 1 0\n");
    for (text, place, part) in [
        (quad, "line 7:", "triangulate"),
        (with("vertex 1 0 0", "vertex 1 0,5 0"), "line 5:", "decimal point"),
        (with("vertex 1 0 0", "vertex 1 nan 0"), "line 5:", "`nan` is not a finite number"),
        (with("vertex 1 0 0", "vertex 1 1e999 0"), "line 5:", "`1e999`"),
        (with("vertex 1 0 0\n", "vertex 1 0\n"), "line 6:", "coordinate `vertex`"),
        (with("outer", "inner"), "line 3:", "`inner` where `outer`"),
        (format!("solid a\n{TRIANGLE}"), "line 9:", "`endsolid`"),
        (
            format!("solid a\r\n{}", TRIANGLE.replace('\n', "\r\n").split_at(60).0),
            "line 5:",
            "cut off",
        ),
        (format!("solid a\n{TRIANGLE}endsolid a\n<html>"), "line 10:", "`<html>` where `solid`"),
        ("solid a\nendsolid a\n".into(), "mesh", "no triangle"),
    ] {
        let message = refusal(&text);
        assert!(message.contains(place) && message.contains(part), "{message}\n{text}");
    }
}

#[test]
fn binary_is_known_by_its_length_whatever_the_header_says() {
    for header in ["solid slope\n", "solid", "SOLID \n\n", "facet", "", "solid \u{e4}\u{f6}"] {
        let mut bytes = binary_bytes(&[corner()]);
        bytes[..header.len()].copy_from_slice(header.as_bytes());
        let soup = parse_text(&bytes).unwrap();
        assert_eq!(soup.facets, [corner()]);
        assert_eq!((soup.format, soup.solids), (Format::Binary, vec![header.trim().to_owned()]));
    }
}

#[test]
fn a_refused_binary_names_the_triangle_or_the_lengths() {
    let whole = binary_bytes(&[corner(), corner()]);
    let mut nan = whole.clone();
    nan[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let mut bomb = whole.clone();
    bomb[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut solid_bomb = bomb.clone();
    solid_bomb[..8].copy_from_slice(b"solid a\n");
    let mut none = whole.clone();
    none[80..84].copy_from_slice(&[0; 4]);
    for (bytes, part) in [
        (whole[..183].to_vec(), "announces 2 triangles = 184 bytes, but has 183"),
        (nan, "triangle 2: corner (NaN"),
        (bomb, "announces 4294967295 triangles"),
        (none.clone(), "announces 0 triangles = 84 bytes, but has 184"),
        (none[..84].to_vec(), "no triangle"),
        (solid_bomb, "announces 4294967295 triangles"),
        (Vec::new(), "the file is empty"),
        (b"<!DOCTYPE html>".repeat(9), "found a web page, no STL"),
        (
            b"Dear Sir or Madam, ".repeat(9),
            "171 bytes that do not begin with `solid`; export the mesh again",
        ),
    ] {
        let message = refusal(&bytes);
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn stored_normals_that_contradict_the_winding_are_noted_not_used() {
    let turned = TRIANGLE.replace("normal 0 0 1", "normal 0 0 -145");
    let short = TRIANGLE.replace("normal 0 0 1", "normal 0 0 1e-6");
    let zero = TRIANGLE.replace("normal 0 0 1", "normal 0 0 0");
    let soup = parse_text(format!("solid\n{short}{turned}{zero}endsolid")).unwrap();
    assert_eq!(soup.normals_off, [1]);
}

#[test]
fn map_coordinates_in_binary_are_refused_and_local_ones_are_not() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("lv95.stl");
    let far = corner().map(|p| p + Vec3::new(2_600_000.0, 1_200_000.0, 1500.0));
    // the spacing of f32 at 2.6e6 is 0.25 m, a quarter of the median edge of 1 m
    let spacing = Spacing::of(&vec![far].into());
    assert_eq!((spacing.spacing, spacing.spoils()), (0.25, true));
    assert!(write_binary(&path, &[far]).unwrap_err().to_string().contains("origin"));
    write_binary(&path, &[corner()]).unwrap();
    assert_eq!(read(&path).unwrap().facets, [corner()]);
    write_ascii(&path, "far", &[far]).unwrap();
    assert_eq!(read(&path).unwrap().facets, [far]);
}

fn any_facet() -> impl Strategy<Value = Facet> {
    let number = prop_oneof![prop::num::f64::NORMAL, -1e7..1e7, Just(0.0), Just(-0.0)];
    prop::array::uniform9(number).prop_map(|n| {
        [Vec3::new(n[0], n[1], n[2]), Vec3::new(n[3], n[4], n[5]), Vec3::new(n[6], n[7], n[8])]
    })
}

/// Words of the grammar and near misses, so that chance gets past the first line.
fn nearly_text() -> impl Strategy<Value = Vec<u8>> {
    let words = "solid,endsolid,facet,normal,outer,loop,vertex,endloop,endfacet,0,1,2.5,nan,-1e400,\n,\r,\r\n,\0,\u{feff},\
                 facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet";
    let words: Vec<String> = words.split(',').map(str::to_owned).collect();
    prop::collection::vec(prop::sample::select(words), 0..40)
        .prop_map(|words| format!("solid {}", words.join(" ")).into_bytes())
}

proptest! {
    /// Text keeps every bit of every number, except the sign of zero in no place: equality of `f64` is enough.
    #[test]
    fn what_text_writes_it_reads_back(facets in prop::collection::vec(any_facet(), 1..20), name in ".*") {
        prop_assert_eq!(parse_text(ascii_text(&name, &facets)).unwrap().facets, facets);
    }

    /// Binary keeps what `f32` can hold.
    #[test]
    fn what_binary_writes_it_reads_back(corners in prop::collection::vec(prop::array::uniform3(any::<i16>()), 3..30)) {
        let points: Vec<Vec3> = corners.iter().map(|c| Vec3::from(c.map(|x| f64::from(x) / 64.0))).collect();
        let facets: Vec<Facet> = points.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        prop_assert_eq!(parse_text(binary_bytes(&facets)).unwrap().facets, facets);
    }

    /// Any bytes give a mesh of finite numbers or a message, never a panic.
    #[test]
    fn no_bytes_make_the_reader_panic(
        bytes in prop_oneof![prop::collection::vec(any::<u8>(), 0..400), nearly_text()]
    ) {
        if let Ok(soup) = parse_text(&bytes) {
            prop_assert!(soup.facets.iter().flatten().all(|p| p.iter().all(|x| x.is_finite())));
            // the shortest facet of a text takes 63 bytes, a binary one 50
            prop_assert!(soup.facets.bytes() <= 4 * bytes.len() + 512);
        }
    }

    /// A valid binary file with one byte changed is read or refused, never a panic.
    #[test]
    fn one_wrong_byte_is_survived(at in 0usize..184, value: u8) {
        let mut bytes = binary_bytes(&[corner(), corner()]);
        bytes[at] = value;
        if let Ok(soup) = parse_text(&bytes) {
            prop_assert_eq!(soup.facets.len(), 2);
        }
    }
}
