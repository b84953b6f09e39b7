//! Tools and what cutting with them takes.

use super::findings::Findings;
use super::machine_file::{MachineFile, ToolTable};
use super::value::At;
use crate::model::{Cutting, CuttingTool};

/// Makes the tools of their tables.
pub(crate) fn tools(findings: &mut Findings<'_>, file: &MachineFile) -> Vec<CuttingTool> {
    let mut tools: Vec<CuttingTool> = Vec::new();
    for table in file.tool.iter().flatten() {
        if file.spindle.is_none() {
            let message = "a tool cuts with the spindle: `[spindle]` is missing";
            findings.error("machine-tool", &table.span, message, None);
        }
        let Some(tool) = tool(findings, table) else {
            continue;
        };
        if tools.iter().any(|other| other.number == tool.number) {
            let message = format!("tool {} is given twice", tool.number);
            findings.error("machine-twice", &table.span, message, None);
        }
        tools.push(tool);
    }
    tools
}

fn tool(findings: &mut Findings<'_>, table: &At<ToolTable>) -> Option<CuttingTool> {
    let ToolTable {
        number,
        cutting_power_w,
        kc_n_mm2,
        width_mm,
        depth_mm,
    } = &table.value;
    let cutting = match (cutting_power_w, kc_n_mm2, width_mm, depth_mm) {
        (Some(power), None, None, None) => Cutting::Power(power.value),
        (None, Some(kc), Some(width), Some(depth)) => {
            Cutting::Force(kc.value * width.value * depth.value)
        }
        _ => {
            if !findings.refused_in("tool") {
                let message =
                    "a tool needs `cutting_power_w`, or `kc_n_mm2` with `width_mm` and `depth_mm`";
                let help = Some("give one of the two".to_owned());
                findings.error("machine-tool", &table.span, message, help);
            }
            return None;
        }
    };
    Some(CuttingTool {
        number: number.as_ref()?.value,
        cutting,
    })
}
