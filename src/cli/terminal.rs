//! What the program prints: in colour where a terminal reads it, plain everywhere else (`NO_COLOR` is honoured).

use super::WRONG_INPUT;
use crate::report::format::significant;
use anstream::{AutoStream, stderr, stdout};
use anstyle::{AnsiColor, Style};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Display;
use std::io::Write as _;
use std::process::ExitCode;
use std::time::Duration;

/// Words at the beginning of a line that are coloured.
const MARKS: [(&str, Style); 8] = [
    ("error:", bold(AnsiColor::Red)),
    ("NOT KEPT:", bold(AnsiColor::Red)),
    ("outside its bound:", bold(AnsiColor::Red)),
    ("warning:", bold(AnsiColor::Yellow)),
    ("interrupted:", bold(AnsiColor::Yellow)),
    ("line \"", bold(AnsiColor::Cyan)),
    ("object \"", bold(AnsiColor::Cyan)),
    ("barrier \"", bold(AnsiColor::Cyan)),
];

const fn bold(colour: AnsiColor) -> Style {
    colour.on_default().bold()
}

/// The text with the marks at the beginnings of its lines in colour; the codes are taken out again where no terminal reads.
fn coloured(text: &str) -> String {
    let line = |line: &str| {
        let mark = MARKS.iter().find(|(mark, _)| line.starts_with(mark));
        // a name in quotation marks is coloured to its end
        let end = |mark: &str| {
            let rest = &line[mark.len()..];
            mark.len() + if mark.ends_with('"') { rest.find('"').map_or(0, |at| at + 1) } else { 0 }
        };
        mark.map_or_else(
            || line.to_owned(),
            |(mark, style)| {
                let (marked, rest) = line.split_at(end(mark));
                format!("{style}{marked}{style:#}{rest}")
            },
        )
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// Says what is wrong; where even that cannot be written (a full disk, nobody there) the status must do.
pub(super) fn complain(text: impl Display) {
    // what stands in a file must not steer the terminal, nor break the line
    let shown = |c: char| {
        if c.is_control() && c != '\n' { c.escape_default().to_string() } else { c.to_string() }
    };
    let text: String = text.to_string().chars().map(shown).collect();
    let _ = writeln!(stderr().lock(), "{}", coloured(&text));
}

/// Prints; a reader that has gone away (`rockfall plan … | head`) is no error.
pub(super) fn say(text: impl Display) -> ExitCode {
    print(stdout().lock(), &coloured(text.to_string().trim_end()))
}

/// Prints what is not for people: scripts and manual pages.
pub(super) fn say_bytes(bytes: &[u8]) -> ExitCode {
    let text = String::from_utf8_lossy(bytes);
    print(AutoStream::never(std::io::stdout().lock()), text.trim_end())
}

fn print(mut out: impl std::io::Write, text: &str) -> ExitCode {
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            complain(format_args!("error: cannot print: {error}"));
            ExitCode::from(WRONG_INPUT)
        }
        _ => ExitCode::SUCCESS,
    }
}

/// A bar over so many things, with rate and remaining time; on a terminal only.
pub(super) fn bar(asked: usize, what: &str) -> ProgressBar {
    let bar = ProgressBar::new(asked as u64);
    let looks = format!("{{bar:40.cyan}} {{pos}}/{{len}} {what}, {{rate}}/s, {{left}} left");
    let Ok(style) = ProgressStyle::with_template(&looks) else { return bar };
    let rate = |state: &ProgressState, to: &mut dyn std::fmt::Write| {
        // the bar is a help, not a result: what it cannot write it leaves out
        let _ = to.write_str(&significant(state.per_sec(), 3));
    };
    let left = |state: &ProgressState, to: &mut dyn std::fmt::Write| {
        let _ = to.write_str(&in_words(state.eta()));
    };
    bar.with_style(style.with_key("rate", rate).with_key("left", left))
}

/// A time as people say it: two units at most, no superfluous digits.
pub(super) fn in_words(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    if seconds < 9.95 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds.round() as u64;
    let (hours, minutes) = (whole / 3600, whole / 60 % 60);
    match (hours, minutes) {
        (0, 0) => format!("{whole} s"),
        (0, _) => format!("{minutes} min {} s", whole % 60),
        _ => format!("{hours} h {minutes} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_two_units_at_most() {
        let said =
            [0.04, 4.26, 59.4, 61.0, 3599.6, 7325.0].map(|s| in_words(Duration::from_secs_f64(s)));
        assert_eq!(said, ["0.0 s", "4.3 s", "59 s", "1 min 1 s", "1 h 0 min", "2 h 2 min"]);
    }

    #[test]
    fn marks_are_coloured_where_a_line_begins() {
        assert_eq!(coloured("no error: here"), "no error: here");
        assert_eq!(coloured("a\nerror: b"), "a\n\u{1b}[1m\u{1b}[31merror:\u{1b}[0m b");
        assert!(coloured("line \"the road\": 3").ends_with("line \"the road\"\u{1b}[0m: 3"));
    }
}
