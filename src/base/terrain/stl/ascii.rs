//! Text STL, read word by word in `f64`: other programs differ in case, line ends, names and blank lines.

use super::{Facet, Format, LastDigits, Soup, unit_normal};
use crate::error::{Error, Result};
use crate::file;
use crate::rock::Vec3;
use std::fmt::Write;
use std::path::Path;

/// Byte order mark of UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Longest word that a message repeats (bytes).
const QUOTED_BYTES: usize = 40;

/// What to do with a file that ends too early.
const CUT_OFF: &str =
    "the file is cut off: export it again (or add `endsolid` if nothing is missing)";

/// Whether the bytes begin with `solid` (any case, after blanks or a byte order mark) and the start is text: a binary
/// file whose length is wrong has zero bytes in its count.
pub(super) fn begins_like_text(bytes: &[u8]) -> bool {
    let start = bytes.strip_prefix(MARK).unwrap_or(bytes).trim_ascii_start();
    let head = &bytes[..bytes.len().min(84)];
    start.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) && !head.contains(&0)
}

/// Reads all solids of a text STL.
pub(super) fn parse(bytes: &[u8], file: &Path) -> Result<Soup> {
    let mut soup = Soup::of_format(Format::Ascii);
    let mut words = WordReader::of(bytes, file);
    while let Some(word) = words.next() {
        words.check(word, "solid", "a file holds `solid … endsolid` and nothing between solids")?;
        soup.solids.push(words.rest_of_line());
        read_solid(&mut words, &mut soup)?;
    }
    Ok(soup)
}

/// Reads facets up to and with the line `endsolid`.
fn read_solid(words: &mut WordReader, soup: &mut Soup) -> Result<()> {
    loop {
        let word = words.some_word("`facet` or `endsolid`")?;
        if word.eq_ignore_ascii_case(b"endsolid") {
            words.rest_of_line();
            return Ok(());
        }
        words.check(word, "facet", "write `facet normal` or `endsolid` here")?;
        let normal = read_normal(words)?;
        words.expect("loop", "write `outer loop`")?;
        let mut facet = [Vec3::zeros(); 3];
        for corner in &mut facet {
            *corner = read_vertex(words, &mut soup.last_digits)?;
        }
        words.expect("endloop", "a facet has three vertices: triangulate the mesh")?;
        words.expect("endfacet", "write `endfacet` after `endloop`")?;
        soup.push(normal, facet);
    }
}

/// Reads up to `outer`. Stored normals may be missing or no numbers: such a normal reads as NaN.
fn read_normal(words: &mut WordReader) -> Result<Vec3> {
    let mut normal = [f64::NAN; 3];
    for at in 0..=4 {
        let word = words.some_word("`outer loop`")?;
        if word.eq_ignore_ascii_case(b"outer") {
            return Ok(normal.into());
        }
        match at {
            0 => words.check(word, "normal", "write `facet normal nx ny nz` and `outer loop`")?,
            4 => words.check(
                word,
                "outer",
                "write `outer loop` after the three numbers of the normal",
            )?,
            _ => normal[at - 1] = number(word).unwrap_or(f64::NAN),
        }
    }
    Ok(normal.into())
}

fn read_vertex(words: &mut WordReader, last_digits: &mut LastDigits) -> Result<Vec3> {
    words.expect("vertex", "a facet has three lines `vertex x y z`")?;
    let mut point = Vec3::zeros();
    for (axis, x) in point.iter_mut().enumerate() {
        let word = words.some_word("a coordinate")?;
        last_digits.see(axis, word);
        *x = number(word).filter(|x| x.is_finite()).ok_or_else(|| {
            let found = format!("coordinate `{}` is not a finite number", quoted(word));
            words.error(found, "write numbers like 12.5 or 1.25e1, with a decimal point")
        })?;
    }
    Ok(point)
}

fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A word for a message: readable and short.
fn quoted(word: &[u8]) -> String {
    String::from_utf8_lossy(&word[..word.len().min(QUOTED_BYTES)]).into_owned()
}

/// The words of a text and the line they stand on.
struct WordReader<'a> {
    text: &'a [u8],
    file: &'a Path,
    /// First byte not yet read.
    at: usize,
    /// Line of that byte, from 1. LF, CR and CR LF end a line.
    line: usize,
}

impl<'a> WordReader<'a> {
    fn of(bytes: &'a [u8], file: &'a Path) -> Self {
        Self { text: bytes.strip_prefix(MARK).unwrap_or(bytes), file, at: 0, line: 1 }
    }

    fn next(&mut self) -> Option<&'a [u8]> {
        while let Some(byte) = self.text.get(self.at).filter(|byte| byte.is_ascii_whitespace()) {
            let ends_line = match byte {
                b'\r' => true,
                b'\n' => self.at == 0 || self.text[self.at - 1] != b'\r',
                _ => false,
            };
            self.line += usize::from(ends_line);
            self.at += 1;
        }
        let rest = &self.text[self.at..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at += length;
        (length > 0).then(|| &rest[..length])
    }

    fn some_word(&mut self, wanted: &str) -> Result<&'a [u8]> {
        self.next()
            .ok_or_else(|| self.error(format!("the file ends where {wanted} should be"), CUT_OFF))
    }

    fn expect(&mut self, keyword: &str, remedy: &str) -> Result<()> {
        let word = self.some_word(&format!("`{keyword}`"))?;
        self.check(word, keyword, remedy)
    }

    fn check(&self, word: &[u8], keyword: &str, remedy: &str) -> Result<()> {
        if word.eq_ignore_ascii_case(keyword.as_bytes()) {
            return Ok(());
        }
        // A wrong word with nothing behind it is most likely half a word.
        let remedy = if self.at == self.text.len() { CUT_OFF } else { remedy };
        Err(self.error(format!("`{}` where `{keyword}` should be", quoted(word)), remedy))
    }

    /// What is left of the line, as UTF-8 or else Latin-1.
    fn rest_of_line(&mut self) -> String {
        let rest = &self.text[self.at..];
        let length = rest.iter().position(|b| matches!(b, b'\r' | b'\n')).unwrap_or(rest.len());
        self.at += length;
        let name = rest[..length].trim_ascii();
        match std::str::from_utf8(name) {
            Ok(name) => name.to_owned(),
            Err(_) => name.iter().map(|&byte| char::from(byte)).collect(),
        }
    }

    fn error(&self, found: impl Into<String>, remedy: &str) -> Error {
        Error::input(self.file, format!("line {}", self.line), found, remedy)
    }
}

/// The facets as a text STL, with the shortest digits that read back to the same `f64`.
///
/// Anything but letters, digits, `-` and `_` in the name becomes `_`: some readers look for numbers in every line.
pub fn ascii_text(name: &str, facets: &[Facet]) -> String {
    let keep = |c: char| if c.is_alphanumeric() || c == '-' { c } else { '_' };
    let name: String = name.chars().map(keep).collect();
    let mut text = format!("solid {name}\n");
    for facet in facets {
        let n = unit_normal(facet);
        // `{:?}` is the shortest round trip, with an exponent where the number is very large or small.
        let _ = write!(text, "facet normal {:?} {:?} {:?}\n outer loop\n", n.x, n.y, n.z);
        for corner in facet {
            let _ = writeln!(text, "  vertex {:?} {:?} {:?}", corner.x, corner.y, corner.z);
        }
        text.push_str(" endloop\nendfacet\n");
    }
    let _ = writeln!(text, "endsolid {name}");
    text
}

/// Writes a text STL.
///
/// # Errors
/// A file that cannot be written.
pub fn write_ascii(path: &Path, name: &str, facets: &[Facet]) -> Result<()> {
    file::write(path, ascii_text(name, facets).as_bytes())
}
