//! `partsight-bench registration`: poses of clouds that share no point.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;

use super::{FrameChoice, NUM_POSES, bounds::opened, write_json};
use crate::{
    registration::{
        Attempt, Condition, NUM_POINTS, Registration, RegistrationPart, RegistrationSetup,
        ablation, register_all,
    },
    suites::MEASURING_SEED,
};
use geometry::statistics::quantile;
use partsight::cli::{
    Outcome,
    console::{Console, Table},
    input::{Choice, choice},
};
use stages::pose::{AlignParams, PoseMethod};

/// The file that `--json` writes.
#[derive(Debug, Serialize)]
struct RegistrationFile {
    schema: u32,
    simulated: bool,
    num_points: usize,
    attempts: Vec<AttemptLine>,
}

#[derive(Debug, Serialize)]
struct AttemptLine {
    condition: Condition,
    method: String,
    part: String,
    source: usize,
    time_ms: f64,
    right: bool,
    rotation_error_deg: Option<f64>,
    shift_error_mm: Option<f64>,
    shift_bound_mm: Option<f64>,
    turn_bound_deg: Option<f64>,
    /// Why there is no pose, or why not to rely on it.
    reason: Option<String>,
}

/// A comparison of methods under one condition.
struct Experiment {
    title: String,
    condition: Condition,
    methods: Vec<(String, AlignParams)>,
}

fn studies(chosen: &[Condition]) -> Vec<Experiment> {
    let named = |method: PoseMethod| (method.name().to_owned(), AlignParams::from(method));
    let mut studies: Vec<Experiment> = Condition::ALL
        .into_iter()
        .filter(|condition| chosen.is_empty() || chosen.contains(condition))
        .map(|condition| Experiment {
            title: condition.title().to_owned(),
            condition,
            methods: match condition {
                Condition::Starts => PoseMethod::ALL.map(named).to_vec(),
                _ => vec![named(PoseMethod::Global)],
            },
        })
        .collect();
    if chosen.is_empty() {
        studies.push(Experiment {
            title: "what ICP-GA is without each of its means, from the same starts".to_owned(),
            condition: Condition::Starts,
            methods: ablation(),
        });
    }
    studies
}

#[derive(Debug, Args)]
pub(super) struct RegistrationArgs {
    #[command(flatten)]
    frames: FrameChoice,
    /// Take this mesh instead of the simulated parts, with its outside towards the camera; may be given several times
    #[arg(long, value_name = "FILE#NAME")]
    mesh: Vec<PathBuf>,
    /// Only sources of this kind; may be given several times
    #[arg(long, value_parser = choice(&CONDITIONS), value_name = "NAME")]
    condition: Vec<Condition>,
}

#[rustfmt::skip]
const CONDITIONS: [Choice<Condition>; 8] = [
    ("whole", "The whole part", Condition::Whole),
    ("view", "One view with a Kinect's noise", Condition::View),
    ("hidden", "30 % hidden", Condition::Hidden),
    ("noisy", "Three times the noise", Condition::Noisy),
    ("stray", "One point in ten anywhere", Condition::Stray),
    ("starts", "From T1..T5 and random starts, with every method", Condition::Starts),
    ("resampled", "Both clouds sampled at random, few or many points", Condition::Resampled),
    ("outside", "Seen from outside, sampled likewise", Condition::Outside),
];

pub(super) fn run(args: &RegistrationArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let studies = studies(&args.condition);
    let parts = if args.mesh.is_empty() {
        RegistrationPart::simulated()
    } else {
        let opened = args.mesh.iter().map(|path| opened(path));
        let part = |(name, mesh)| RegistrationPart::of_mesh(name, mesh);
        opened
            .map(|opened| opened.map(part))
            .collect::<anyhow::Result<_>>()?
    };
    let num_sources = args.frames.poses.unwrap_or(NUM_POSES) as usize;
    let num_methods: usize = studies.iter().map(|study| study.methods.len()).sum();
    console.start_progress(num_methods * num_sources * parts.len());
    let mut done = Vec::new();
    for study in studies {
        console.begin(&study.title);
        let setup = RegistrationSetup {
            parts: parts.clone(),
            condition: study.condition,
            num_sources,
            seed: args.frames.seed.unwrap_or(MEASURING_SEED),
            methods: study.methods.clone(),
        };
        let registration = register_all(&setup, || console.done());
        done.push((study, registration));
    }
    console.end_progress();
    console.line(&format_args!(
        "Simulated: {} parts, {num_sources} sources of each, {NUM_POINTS} points each (of a view: at most), one core. Right: within 2° and 1 cm.",
        parts.len()
    ));
    show(&done, &parts, console);
    if let Some(path) = &args.frames.file.json {
        let file = RegistrationFile {
            schema: 1,
            simulated: true,
            num_points: NUM_POINTS,
            attempts: done.iter().flat_map(|(s, r)| lines(s, r)).collect(),
        };
        write_json(path, &file)?;
    }
    Ok(Outcome::Accepted)
}

fn show(done: &[(Experiment, Registration)], parts: &[RegistrationPart], console: &mut Console) {
    for (study, registration) in done {
        console.line(&"");
        console.line(&study.title);
        let mut table = Table::new(&[
            "method",
            "right",
            "right or doubted",
            "doubted though right",
            "within its bounds",
            "median error",
            "median time",
            "95 %",
        ]);
        for (method, _) in &study.methods {
            let attempts = || registration.attempts.iter().filter(|a| a.method == *method);
            let num = attempts().count();
            let count = |is: fn(&Attempt) -> bool| attempts().filter(|a| is(a)).count();
            let right = || {
                let found = attempts().filter(|a| a.is_right());
                found.filter_map(|a| a.found.as_ref().ok())
            };
            let turn = quantile(right().map(|f| f.error.rotation.degrees()), 0.5);
            let shift = quantile(right().map(|f| f.error.shift.mm()), 0.5);
            let error = turn.zip(shift);
            let time = |share| {
                let time = quantile(attempts().map(time_ms), share);
                time.map_or_else(String::new, |ms| format!("{ms:.1} ms"))
            };
            table.row([
                method.clone(),
                format!("{}/{num}", count(Attempt::is_right)),
                format!("{}/{num}", count(|a| a.is_right() || a.is_doubted())),
                count(|a| a.is_right() && a.is_doubted()).to_string(),
                format!(
                    "{}/{}",
                    count(|a| a.is_right() && a.is_within_bounds()),
                    count(Attempt::is_right)
                ),
                error.map_or_else(String::new, |(turn, shift)| {
                    format!("{turn:.3}° {shift:.2} mm")
                }),
                time(0.5),
                time(0.95),
            ]);
        }
        console.table(&table);
        if study.methods.len() == 1 {
            by_part(registration, parts, console);
        }
    }
    let preparations = done.iter().flat_map(|(_, r)| &r.preparations);
    if let Some(ms) = quantile(preparations.map(|t| t.as_secs_f64() * 1e3), 0.5) {
        console.line(&"");
        console.line(&format_args!(
            "Preparing a target: {ms:.1} ms (median), not in the times above."
        ));
    }
}

/// Lists the parts with missed poses, and how many of the misses had no warning.
fn by_part(registration: &Registration, parts: &[RegistrationPart], console: &mut Console) {
    for RegistrationPart { name, .. } in parts {
        let attempts = || registration.attempts.iter().filter(|a| a.part == *name);
        let missed = attempts().filter(|a| !a.is_right()).count();
        let silent = attempts().filter(|a| !a.is_right() && !a.is_doubted());
        if missed > 0 {
            console.line(&format_args!(
                "  {name}: {missed} of {} not right, {} of them without a doubt",
                attempts().count(),
                silent.count()
            ));
        }
    }
}

fn time_ms(attempt: &Attempt) -> f64 {
    attempt.time.as_secs_f64() * 1e3
}

fn lines(study: &Experiment, registration: &Registration) -> Vec<AttemptLine> {
    let line = |attempt: &Attempt| {
        let found = attempt.found.as_ref().ok();
        let failure = attempt.found.as_ref().err().map(ToString::to_string);
        AttemptLine {
            condition: study.condition,
            method: attempt.method.clone(),
            part: attempt.part.clone(),
            source: attempt.source,
            time_ms: time_ms(attempt),
            right: attempt.is_right(),
            rotation_error_deg: found.map(|f| f.error.rotation.degrees()),
            shift_error_mm: found.map(|f| f.error.shift.mm()),
            shift_bound_mm: found.and_then(|f| f.bounds).map(|u| u.shift.mm()),
            turn_bound_deg: found.and_then(|f| f.bounds).map(|u| u.turn.degrees()),
            reason: failure.or_else(|| found?.doubt.map(|doubt| doubt.to_string())),
        }
    };
    registration.attempts.iter().map(line).collect()
}
