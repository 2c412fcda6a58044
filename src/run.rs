//! What the program uses: the command line, checked and resolved. Nothing later looks at flags.

use crate::args::{self, ConvertArgs, ModelArgs, OutputFormat};
use crate::failure::Failure;
use crate::input::Input;
use crate::memory;
use crate::report::SettingsReport;
use crate::streams::{Loop, find_loop};
use crate::thesis::pipe::DialectArgs;
use crate::values::Tolerance;
use csg::Aabb;
use glam::DVec3;
use io::read::ReadOptions;
use io::write::Unit;
use std::path::{Path, PathBuf};

/// Where a file goes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Target {
    /// Standard output.
    Stdout,
    /// A file, replaced when it is complete.
    File(PathBuf),
}

/// A mesh to write.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) struct Output {
    pub(crate) target: Target,
    pub(crate) format: OutputFormat,
}

/// A model and how to subdivide it.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    pub(crate) input: Input,
    pub(crate) read: ReadOptions,
    /// How the thesis' files are read and written.
    pub(crate) dialect: DialectArgs,
    pub(crate) clip: Option<Aabb>,
    pub(crate) precision: Precision,
    pub(crate) max_level: Option<u8>,
    pub(crate) criterion: subdiv::Criterion,
    pub(crate) mesh: args::MeshKind,
    pub(crate) fit: brep::Fit,
    /// Whether true surfaces are to be written, for which the topology is proved.
    pub(crate) has_step: bool,
    /// Whether nothing else is to be written, so that facets are not needed.
    pub(crate) is_step_only: bool,
    pub(crate) threads: Option<usize>,
    pub(crate) max_cells: u64,
    pub(crate) max_memory_bytes: u64,
}

/// When subdivision ends.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Precision {
    Tolerance(Tolerance),
    Level(u8),
    /// When the topology is proved, or cells are this small.
    Topology(Tolerance),
}

/// A conversion.
#[derive(Clone, Debug)]
pub(crate) struct Conversion {
    pub(crate) job: Job,
    pub(crate) from: Option<args::InputFormat>,
    pub(crate) outputs: Vec<Output>,
    pub(crate) unit: Option<Unit>,
    pub(crate) report: Option<Target>,
    pub(crate) strict: bool,
}

impl Target {
    /// `-` is standard output.
    pub(crate) fn new(path: PathBuf) -> Self {
        if path == Path::new("-") {
            Self::Stdout
        } else {
            Self::File(path)
        }
    }

    /// The name for messages.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Stdout => "<stdout>".to_owned(),
            Self::File(path) => path.display().to_string(),
        }
    }
}

impl Job {
    pub(crate) fn new(input: PathBuf, args: &ModelArgs) -> Result<Self, Failure> {
        if args.level.is_some() && args.mesh == args::MeshKind::Surfaces {
            let text = "--mesh surfaces needs a tolerance: leave out --level";
            return Err(Failure::Usage(text.to_owned()));
        }
        if args.fit == args::FitKind::Mean && args.mesh != args::MeshKind::Surfaces {
            let text = "--fit mean moves the facets of --mesh surfaces: add that";
            return Err(Failure::Usage(text.to_owned()));
        }
        Ok(Self {
            input: Input::new(input),
            read: ReadOptions {
                facet_limit: args.facet_limit,
                max_degree: args.max_degree,
            },
            dialect: args.dialect,
            clip: args.clip.as_deref().map(clip_box).transpose()?,
            precision: match (args.level, args.tolerance.unwrap_or_default()) {
                (Some(level), _) => Precision::Level(level),
                (None, finest) if args.topology_only => Precision::Topology(finest),
                (None, tolerance) => Precision::Tolerance(tolerance),
            },
            max_level: args.max_level,
            criterion: match args.criterion {
                args::Criterion::Bezier => subdiv::Criterion::Bezier,
                args::Criterion::Rivlin => subdiv::Criterion::Rivlin,
                args::Criterion::Lipschitz => subdiv::Criterion::Lipschitz,
            },
            mesh: args.mesh,
            fit: match args.fit {
                args::FitKind::Inscribed => brep::Fit::Inscribed,
                args::FitKind::Mean => brep::Fit::Mean,
            },
            has_step: false,
            is_step_only: false,
            threads: args.threads.map(usize::from),
            max_cells: args.max_cells.get(),
            max_memory_bytes: memory::allowed_bytes(args.memory),
        })
    }

    /// The rule that was asked for, of a solid whose extent has this diagonal.
    pub(crate) fn rule(&self, diagonal: f64) -> subdiv::Rule {
        match self.precision {
            Precision::Level(level) => subdiv::Rule::Level(level),
            Precision::Tolerance(tolerance) => subdiv::Rule::Tolerance(tolerance.length(diagonal)),
            Precision::Topology(finest) => subdiv::Rule::Topology {
                finest: finest.length(diagonal),
            },
        }
    }

    /// The settings of a subdivision by this rule.
    pub(crate) fn settings(&self, rule: subdiv::Rule) -> subdiv::Settings {
        subdiv::Settings {
            max_level: self.max_level,
            criterion: self.criterion,
            threads: self.threads,
            max_cells: self.max_cells,
            max_memory_bytes: self.max_memory_bytes,
            ..subdiv::Settings::new(rule)
        }
    }

    /// The settings for the report; the tolerance is not known yet if it is relative.
    pub(crate) fn report(&self) -> SettingsReport {
        let (tolerance, level) = match self.precision {
            Precision::Tolerance(Tolerance::Length(length))
            | Precision::Topology(Tolerance::Length(length)) => (Some(length), None),
            Precision::Tolerance(Tolerance::OfDiagonal(_))
            | Precision::Topology(Tolerance::OfDiagonal(_)) => (None, None),
            Precision::Level(level) => (None, Some(level)),
        };
        let clip = self.clip.map(|clip| {
            let ([a, b, c], [d, e, f]) = (clip.min.to_array(), clip.max.to_array());
            [a, b, c, d, e, f]
        });
        SettingsReport {
            tolerance,
            level,
            topology_only: matches!(self.precision, Precision::Topology(_)),
            max_level: self.max_level,
            criterion: match self.criterion {
                subdiv::Criterion::Rivlin => "rivlin",
                subdiv::Criterion::Lipschitz => "lipschitz",
                subdiv::Criterion::Bezier => "bezier",
            },
            mesh: match self.mesh {
                args::MeshKind::Surfaces => "surfaces",
                args::MeshKind::Merged => "merged",
                args::MeshKind::Leaves => "leaves",
            },
            fit: match self.fit {
                brep::Fit::Inscribed => "inscribed",
                brep::Fit::Mean => "mean",
            },
            clip,
            facet_limit: self.read.facet_limit,
            max_degree: self.read.max_degree,
            max_cells: self.max_cells,
            max_memory_bytes: self.max_memory_bytes,
            threads: self.threads,
        }
    }
}

impl Conversion {
    pub(crate) fn new(args: ConvertArgs) -> Result<Self, Failure> {
        let Some(input) = args.input else {
            return Err(Failure::Usage("no input".to_owned()));
        };
        if args.outputs.is_empty() && args.report.is_none() {
            let text = "nothing to write: name an output, as in -o part.glb";
            return Err(Failure::Usage(text.to_owned()));
        }
        let to = args.to;
        let outputs = args.outputs.into_iter().map(|path| output(path, to));
        let outputs = outputs.collect::<Result<Vec<_>, _>>()?;
        let report = args.report.map(Target::new);
        let mut job = Job::new(input, &args.model)?;
        let is_step = |output: &Output| output.format == OutputFormat::Step;
        job.has_step = outputs.iter().any(is_step);
        job.is_step_only = job.has_step && outputs.iter().all(is_step);
        if job.is_step_only
            && let Precision::Tolerance(finest) = job.precision
        {
            job.precision = Precision::Topology(finest);
        }
        let targets: Vec<&Target> = outputs.iter().map(|o| &o.target).chain(&report).collect();
        check_targets(&job.input, &targets)?;
        Ok(Self {
            job,
            from: args.from,
            outputs,
            unit: args.unit.map(Unit::from),
            report,
            strict: args.strict,
        })
    }
}

impl From<args::LengthUnit> for Unit {
    fn from(unit: args::LengthUnit) -> Self {
        match unit {
            args::LengthUnit::Um => Self::Micron,
            args::LengthUnit::Mm => Self::Millimetre,
            args::LengthUnit::Cm => Self::Centimetre,
            args::LengthUnit::M => Self::Metre,
            args::LengthUnit::In => Self::Inch,
            args::LengthUnit::Ft => Self::Foot,
        }
    }
}

/// Six finite numbers, the first three below the last three.
pub(crate) fn clip_box(numbers: &[f64]) -> Result<Aabb, Failure> {
    let wrong = |why: &str| Failure::Usage(format!("--box: {why}"));
    let &[a, b, c, d, e, f] = numbers else {
        return Err(wrong("six numbers are needed"));
    };
    let (min, max) = (DVec3::new(a, b, c), DVec3::new(d, e, f));
    if !(min.is_finite() && max.is_finite()) {
        return Err(wrong("all numbers must be finite"));
    }
    for (axis, name) in ["X", "Y", "Z"].into_iter().enumerate() {
        if min[axis] >= max[axis] {
            let (low, high) = (min[axis], max[axis]);
            return Err(wrong(&format!(
                "{name}MIN must be below {name}MAX, found {low} and {high}"
            )));
        }
    }
    Ok(Aabb { min, max })
}

fn output(path: PathBuf, to: Option<OutputFormat>) -> Result<Output, Failure> {
    let target = Target::new(path);
    let format = match (&target, to) {
        (_, Some(format)) => format,
        (Target::Stdout, None) => {
            let text = "standard output needs a format: --to obj, glb, stl, 3mf or ply";
            return Err(Failure::Usage(text.to_owned()));
        }
        (Target::File(path), None) => {
            let extension = path
                .extension()
                .map(|e| e.to_string_lossy().to_ascii_lowercase());
            match extension.as_deref() {
                Some("obj") => OutputFormat::Obj,
                Some("glb") => OutputFormat::Glb,
                Some("stl") => OutputFormat::Stl,
                Some("3mf") => OutputFormat::Threemf,
                Some("ply") => OutputFormat::Ply,
                Some("step" | "stp") => OutputFormat::Step,
                Some("csg") => OutputFormat::ThesisCsg,
                Some("cspg") => OutputFormat::Cspg,
                Some("apl") => OutputFormat::Apl,
                Some("wfr") => OutputFormat::Wfr,
                _ => {
                    return Err(Failure::Usage(format!(
                        "{}: no format has this extension (known: .obj, .glb, .stl, .3mf, .ply, .step, .CSG, .cspg, .apl, .wfr; or choose one with --to)",
                        path.display()
                    )));
                }
            }
        }
    };
    Ok(Output { target, format })
}

/// No two files may be one, nor the input be overwritten.
pub(crate) fn check_targets(input: &Input, targets: &[&Target]) -> Result<(), Failure> {
    for (at, target) in targets.iter().enumerate() {
        check_folder(target)?;
        if targets.iter().take(at).any(|other| other == target) {
            return Err(Failure::Usage(format!("{}: given twice", target.name())));
        }
        let (name, source) = (target.name(), input.name());
        match find_loop(input, target) {
            None => {}
            Some(Loop::File) if matches!((target, input), (Target::File(_), Input::File(_))) => {
                let text = format!("{name}: the output would replace the input");
                return Err(Failure::Usage(text));
            }
            Some(Loop::File) => {
                let text = format!(
                    "{source} and {name} are one file: a shell empties it before it is read (write \
                     to another file, then rename it)"
                );
                return Err(Failure::Usage(text));
            }
            Some(Loop::Pipe) => {
                let text = format!(
                    "{source} and {name} are the ends of one pipe: each would wait for the other \
                     (read from a file, or write to one)"
                );
                return Err(Failure::Usage(text));
            }
        }
    }
    Ok(())
}

/// A missing folder is better told before the work than after it.
pub(crate) fn check_folder(target: &Target) -> Result<(), Failure> {
    let Target::File(path) = target else {
        return Ok(());
    };
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
    match folder.map(std::fs::metadata) {
        Some(Err(cause)) => Err(Failure::writing(path, cause)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_checked_axis_by_axis() {
        assert!(clip_box(&[0., 0., 0., 1., 1., 1.]).is_ok());
        let flat = clip_box(&[0., 2., 0., 1., 1., 1.]).unwrap_err();
        assert_eq!(
            flat.to_string(),
            "--box: YMIN must be below YMAX, found 2 and 1"
        );
        assert!(clip_box(&[0., 0., 0., 1., 1., f64::INFINITY]).is_err());
        assert!(clip_box(&[f64::NAN, 0., 0., 1., 1., 1.]).is_err());
    }

    #[test]
    fn extensions_tell_formats() {
        let format = |name: &str| output(name.into(), None).map(|o| o.format).ok();
        assert_eq!(format("a.GLB"), Some(OutputFormat::Glb));
        assert_eq!(format("a.b.obj"), Some(OutputFormat::Obj));
        assert_eq!(format("a.txt"), None);
        assert_eq!(format("-"), None);
        let stdout = output("-".into(), Some(OutputFormat::Stl)).unwrap();
        assert_eq!(stdout.target, Target::Stdout);
    }
}
