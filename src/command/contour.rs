//! `gwatt contour`.

use std::io::{self, Write};
use std::path::Path;
use std::slice;

use anyhow::{Context, Result, ensure};
use gwatt::contour::{ContourRow, ContourSink, ContourSummary, PlotPoint, Settings, Tracer};
use gwatt::pipeline::{self, Failure, MotionNotes};
use gwatt::report::{
    ArcList, CONTOUR_COLUMNS, ContourChart, Verdict, circle_chart, contour_csv_row, contour_json,
    contour_json_row, contour_text,
};

use super::clash::refuse_clashes;
use super::dialect;
use super::input::{Program, is_dash};
use super::output::{Spool, Target, print};
use super::settings;
use super::setup::{Setup, machine_file};
use super::terminal::Terminal;
use crate::cli::ContourArgs;

/// Shorter steps bring nothing, and take long.
const STEP_MIN_MS: f64 = 0.01;
const STEP_MAX_MS: f64 = 20.0;

/// Says how far the load is from the programmed path.
pub fn run(args: &ContourArgs, terminal: Terminal) -> Result<Verdict> {
    let mut program = Program::new(&args.program);
    let mut args = args.clone();
    let given = settings::Settings::of(slice::from_ref(&program), terminal)?;
    given.fill(&mut args.machine, &mut args.reading)?;
    let args = &args;
    let machine = machine_file(args.machine.machine.as_deref());
    let inputs: Vec<&Path> = program.path().into_iter().chain(machine).collect();
    let files = [&args.csv, &args.json, &args.svg, &args.circles];
    let outputs: Vec<&Path> = files.into_iter().flatten().map(AsRef::as_ref).collect();
    refuse_clashes(&inputs, &outputs)?;
    ensure!(
        (STEP_MIN_MS..=STEP_MAX_MS).contains(&args.step_ms),
        "--step-ms {} is not between {STEP_MIN_MS} and {STEP_MAX_MS}",
        args.step_ms
    );
    let mut setup = Setup::new(&args.machine, &args.reading, terminal)?;
    setup.one_way("`contour` shows")?;
    dialect::settle(&mut setup, slice::from_mut(&mut program), terminal)?;
    let mut collected = Collected::new(args, !setup.machine.responses.corrections.is_empty())?;
    let settings = Settings {
        period_s: args.step_ms * 1e-3,
    };
    let traced = program.open().and_then(|input| {
        let refuse = |trouble: &dyn std::fmt::Display| Failure::Unsuitable(trouble.to_string());
        let mut tracer = Tracer::new(&setup.machine, settings, &mut collected)
            .map_err(|trouble| refuse(&trouble))?;
        let options = setup.options_for(&program);
        let notes = pipeline::motion(input, &setup.machine, &options, &mut |stretch| {
            tracer.push(stretch)
        })?;
        Ok((tracer.finish()?, notes))
    });
    let (mut summary, notes) = match traced {
        Ok(found) => found,
        Err(failure) => {
            terminal.say(|messages| dialect::failure(&setup, &program, &failure, messages));
            return Ok(Verdict::Refused);
        }
    };
    add_conditions(&mut summary, &notes);
    let machine = &setup.machine.name;
    let text = contour_text(
        &program.name,
        machine,
        &summary,
        collected.arcs.arcs(),
        collected.arcs.more,
    );
    collected.deliver(args, &program.name, machine, &summary)?;
    terminal.diagnostics(&program.name, &notes.notes);
    if files.into_iter().flatten().any(|path| is_dash(path)) {
        terminal.text(&text);
    } else {
        print(|out| out.write_all(text.as_bytes()))?;
    }
    Ok(Verdict::Fits)
}

fn add_conditions(summary: &mut ContourSummary, notes: &MotionNotes) {
    if notes.stops_instead {
        summary.conditions.push(
            "how the controller blends is not modelled: each move was run from rest to rest"
                .to_owned(),
        );
    }
}

/// Results on their way.
struct Collected {
    corrected: bool,
    csv: Option<Spool>,
    json_rows: Option<(Spool, Spool)>,
    first: bool,
    chart: Option<ContourChart>,
    arcs: ArcList,
}

impl Collected {
    fn new(args: &ContourArgs, corrected: bool) -> Result<Self> {
        let spool = |path: &Path| Target::new(path)?.spool();
        let mut csv = args.csv.as_deref().map(spool).transpose()?;
        if let Some(csv) = &mut csv {
            writeln!(csv, "{CONTOUR_COLUMNS}").context("cannot write the table")?;
        }
        // Rows wait in a file, because the head of the file is known last.
        let json_rows = match args.json.as_deref() {
            Some(path) => Some((spool(path)?, Target::Stdout.spool()?)),
            None => None,
        };
        Ok(Self {
            corrected,
            csv,
            json_rows,
            first: true,
            chart: args.svg.as_ref().map(|_| ContourChart::default()),
            arcs: ArcList::default(),
        })
    }

    fn deliver(
        self,
        args: &ContourArgs,
        program: &str,
        machine: &str,
        summary: &ContourSummary,
    ) -> Result<()> {
        let mut spools = Vec::new();
        if let Some((mut spool, mut rows)) = self.json_rows {
            contour_json(program, machine, summary, &mut rows.read()?, &mut spool)
                .context("cannot write the JSON")?;
            spools.push(spool);
        }
        if let (Some(path), Some(chart)) = (&args.svg, &self.chart) {
            let mut spool = Target::new(path)?.spool()?;
            chart
                .write(&mut spool)
                .context("cannot write the picture")?;
            spools.push(spool);
        }
        if let Some(path) = &args.circles {
            let mut spool = Target::new(path)?.spool()?;
            circle_chart(self.arcs.arcs(), &mut spool).context("cannot write the picture")?;
            spools.push(spool);
        }
        spools.extend(self.csv);
        spools.into_iter().try_for_each(Spool::deliver)
    }
}

impl ContourSink for Collected {
    fn row(&mut self, row: &ContourRow) -> io::Result<()> {
        if let Some(csv) = &mut self.csv {
            contour_csv_row(row, self.corrected, csv)?;
        }
        if let Some((_, rows)) = &mut self.json_rows {
            let comma = if self.first { "" } else { "," };
            write!(rows, "{comma}\n    ")?;
            contour_json_row(row, self.corrected, rows)?;
            self.first = false;
        }
        if let Some(arc) = &row.arc {
            self.arcs.take(arc);
        }
        Ok(())
    }

    fn point(&mut self, point: &PlotPoint) {
        if let Some(chart) = &mut self.chart {
            chart.add(point);
        }
    }
}
