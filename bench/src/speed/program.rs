//! The whole program on a file: time to read, weld, examine, index and plan, and the most memory it takes.

use super::machine::peak_bytes;
use super::parts::BASE;
use super::slope::facets;
use rockfall::error::{Error, Result};
use rockfall::terrain::stl::write_binary;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// How often a running program is asked how much memory it has taken so far.
const LOOK: Duration = Duration::from_millis(2);

/// One run of the program.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgramRun {
    /// Triangles of the slope.
    pub triangles: usize,
    /// Releases; none if only the plan was made.
    pub releases: Option<usize>,
    /// Time by the clock (s).
    pub seconds: f64,
    /// Time that it computed (s), all threads together; none where the system does not tell.
    pub computed_s: Option<f64>,
    /// Most memory it took (bytes); none where the system does not tell.
    pub peak_bytes: Option<u64>,
}

/// Plans, and then runs, the benchmark's scene with slopes of these sizes; `dir` is a folder to work in.
///
/// # Errors
/// If a file cannot be written or the program cannot be started or fails.
pub fn runs(
    program: &Path,
    dir: &Path,
    triangles: &[usize],
    releases: usize,
) -> Result<Vec<ProgramRun>> {
    let mut found = Vec::new();
    for &size in triangles {
        let facets = facets(size);
        let triangles = facets.len();
        write_binary(&dir.join("slope.stl"), &facets)?;
        drop(facets);
        let scene = dir.join("whole.toml");
        let text = BASE.replace("count = 1\n", &format!("count = {releases}\n"));
        fs::write(&scene, text).map_err(Error::file("write", &scene))?;
        for releases in [None, Some(releases)] {
            let mut command = Command::new(program);
            if releases.is_some() {
                let out = dir.join("whole");
                command.args(["run", "--quiet", "--overwrite", "--threads", "1", "--out"]).arg(out);
            } else {
                command.arg("plan");
            }
            found.push(observe(command.arg(&scene), triangles, releases)?);
        }
    }
    Ok(found)
}

fn observe(command: &mut Command, triangles: usize, releases: Option<usize>) -> Result<ProgramRun> {
    let failed = |why: String| Error::Request(format!("{}: {why}", command_name(command)));
    let begun = Instant::now();
    let before = children_s();
    let started = Command::new(command.get_program())
        .args(command.get_args())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn();
    let mut child = started.map_err(|why| failed(format!("cannot be started: {why}")))?;
    let (ended_well, peak_bytes) = wait(&mut child).map_err(|why| failed(why.to_string()))?;
    let seconds = begun.elapsed().as_secs_f64();
    if !ended_well {
        return Err(failed("has failed".to_owned()));
    }
    let computed_s = before.zip(children_s()).map(|(before, after)| after - before);
    Ok(ProgramRun { triangles, releases, seconds, computed_s, peak_bytes })
}

fn command_name(command: &Command) -> String {
    command.get_program().to_string_lossy().into_owned()
}

/// Whether it ended well, and the most memory it was seen to have taken.
fn wait(child: &mut Child) -> std::io::Result<(bool, Option<u64>)> {
    let mut peak = None;
    loop {
        // The high-water mark only rises, so the last look before the end has it.
        peak = peak.max(peak_bytes(child.id()));
        if let Some(status) = child.try_wait()? {
            return Ok((status.success(), peak));
        }
        std::thread::sleep(LOOK);
    }
}

/// Time that all programs started and ended so far have computed (s): fields 16 and 17 of the system's account, in ticks
/// of which Linux shows 100 a second.
fn children_s() -> Option<f64> {
    let text = fs::read_to_string("/proc/self/stat").ok()?;
    // the name in brackets may hold blanks
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |field: usize| fields.get(field - 3)?.parse::<f64>().ok();
    Some((ticks(16)? + ticks(17)?) / 100.0)
}
