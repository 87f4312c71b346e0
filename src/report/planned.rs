//! What the plan of a run says of its parts.

use crate::plan::PlanEntry;

/// How a part of the plan begins that is left out.
const LEFT_OUT: &str = "left out";

/// What the plan says of a part, if it keeps it.
pub(super) fn kept<'a>(plan: &'a [PlanEntry], part: &str) -> Option<&'a str> {
    let entry = plan.iter().find(|entry| entry.name == part)?;
    Some(entry.said.as_str()).filter(|said| !said.starts_with(LEFT_OUT))
}

/// Whether the plan says that it leaves a part out.
pub(super) fn is_left_out(plan: &[PlanEntry], part: &str) -> bool {
    plan.iter().any(|entry| entry.name == part) && kept(plan, part).is_none()
}

/// Whether the rocks of a run share one world and meet each other.
pub(super) fn is_one_world(plan: &[PlanEntry]) -> bool {
    kept(plan, "rock against rock").is_some()
}
