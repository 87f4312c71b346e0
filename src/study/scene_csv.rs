//! The errors of a scene as CSV.

use super::bootstrap::Interval;
use super::scene::SceneStudy;
use std::fmt::Write as _;

/// What coarser meshes make of the statistics as CSV: one row a statistic and mesh.
pub(super) fn mesh_csv(study: &SceneStudy) -> String {
    let mut text = String::from(
        "quantity,percent,edge_m,triangles,seconds,failed,value,mesh_error,mesh_error_low_95,mesh_error_high_95\n",
    );
    for statistic in &study.statistics {
        let Some(meshes) = &statistic.meshes else { continue };
        for (mesh, value) in study.meshes.iter().zip(&meshes.values) {
            let Interval { value: error, low, high } = statistic.mesh_error_of(mesh);
            let _ = writeln!(
                text,
                "{},{},{:.3},{},{:.3},{},{value},{error},{low},{high}",
                study.subjects[statistic.subject].column,
                statistic.percent,
                mesh.edge_m,
                mesh.triangles,
                mesh.rung.seconds,
                mesh.rung.failed,
            );
        }
    }
    text
}

/// All numbers as CSV: one row a statistic and setting.
pub(super) fn csv(study: &SceneStudy) -> String {
    let mut text = String::from(
        "quantity,percent,fineness,seconds,steps,rejected,leaps,sweeps,triangles,unsettled,failed,value,step_error,step_error_low_95,step_error_high_95,sampling_error_95,corner_way\n",
    );
    for statistic in &study.statistics {
        for (rung, value) in study.rungs.iter().zip(&statistic.ladder.values) {
            let step = &rung.step;
            let by_tolerance = step.scheme.controls_error();
            let fineness = if by_tolerance { step.tolerance_m_s } else { step.step_s };
            let error = statistic.step_error(rung.relative, step.scheme);
            let sampling =
                statistic.sampling_error().map_or(String::new(), |half| half.to_string());
            let effort = &rung.effort;
            let _ = writeln!(
                text,
                "{},{},{fineness},{:.3},{},{},{},{},{},{},{},{value},{},{},{},{sampling},{}",
                study.subjects[statistic.subject].column,
                statistic.percent,
                rung.seconds,
                effort.steps,
                effort.rejected,
                effort.leaps,
                effort.sweeps,
                effort.triangles,
                effort.unsettled,
                rung.failed,
                error.value,
                error.low,
                error.high,
                step.corner_way
            );
        }
    }
    text
}
