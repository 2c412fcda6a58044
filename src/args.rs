//! The command line as it is typed. [`run`](crate::run) turns it into what the program uses.

use crate::thesis::ThesisCommand;
use crate::thesis::pipe::DialectArgs;
use crate::values::{Bytes, PictureSize, Tolerance, Viewpoint};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use std::num::{NonZeroU64, NonZeroUsize};
use std::path::PathBuf;

const EXAMPLES: &str = "\
Examples:
  csg2brep part.csg -o part.glb                      one file, at 0.1% of the model's size
  csg2brep part.csg -o part.stl -o part.obj --tolerance 0.01
  csg2brep view part.csg -o part.png                 a picture

An OpenSCAD program is evaluated first:
  openscad -o part.csg part.scad";

const EXIT_CODES: &str = "\
Exit codes:
  0    done
  1    bad input, or a file that could not be read or written
  2    bad usage
  3    done, but not certified to the tolerance (only with --strict);
       the mesh is no closed, oriented manifold (only of `check`)
  4    a limit was reached: cells, memory, or the model's size
  130  interrupted";

/// Constructive solid geometry to watertight meshes.
#[derive(Parser, Debug)]
#[command(
    version,
    override_usage = "csg2brep [OPTIONS] <IN> -o <FILE>...\n       csg2brep <COMMAND>",
    before_help = EXAMPLES,
    after_long_help = EXIT_CODES,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    disable_help_subcommand = true
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    #[command(flatten)]
    pub(crate) convert: ConvertArgs,
    #[command(flatten)]
    pub(crate) talk: TalkArgs,
}

/// What to do, if it is not a plain conversion.
#[derive(Subcommand, Debug)]
pub(crate) enum Command {
    /// Convert a model, as without a command
    Convert(ConvertArgs),
    /// Draw a picture of a model, or make a page to look at it from all sides
    View(ViewArgs),
    /// Print what a model consists of, without converting it
    Info(InfoArgs),
    /// Print area, volume, centroid and inertia, of each solid and of all together
    Properties(PropertiesArgs),
    /// Say whether a mesh file is a closed, oriented manifold, and where it is not
    Check(CheckArgs),
    /// Repeat the programs and experiments of the thesis behind this program
    #[command(subcommand)]
    Thesis(ThesisCommand),
    /// Print a script that completes commands and options in a shell
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Print the manual page
    Man,
    /// Print the JSON schema of what `--report`, `check --json` or `properties --json` writes
    ReportSchema {
        /// Which of them
        #[arg(value_name = "REPORT", default_value = "convert")]
        of: SchemaOf,
    },
}

/// How much is said, and how.
#[derive(Args, Clone, Copy, Debug)]
#[command(next_help_heading = "Messages")]
pub(crate) struct TalkArgs {
    /// Say nothing but errors
    #[arg(short, long, global = true, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say more: stages with their times, counts, places that are not certified
    #[arg(short, long, global = true)]
    pub(crate) verbose: bool,
    /// When to use colours; NO_COLOR is honoured
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    pub(crate) color: ColorChoice,
}

/// When to use colours.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum ColorChoice {
    /// On a terminal
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// Input, output and precision of a conversion.
#[derive(Args, Debug)]
pub(crate) struct ConvertArgs {
    /// The model to read; `-` is standard input
    // An option only in type: clap cannot know that there is no command when it fills this in.
    #[arg(value_name = "IN", required = true)]
    pub(crate) input: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// The file to write; its extension tells the format. Repeat it for several formats.
    /// `-` is standard output and needs --to
    #[arg(short, long = "output", value_name = "FILE")]
    pub(crate) outputs: Vec<PathBuf>,
    /// The format of the output, whatever its extension
    #[arg(long, value_name = "FORMAT", requires = "outputs")]
    pub(crate) to: Option<OutputFormat>,
    /// What a model unit is, for formats that say it: 3MF (mm if not given), GLB (m if not
    /// given), OBJ and PLY (a comment). Coordinates change in STEP only, which is in millimetres
    #[arg(long, value_name = "UNIT", requires = "outputs")]
    pub(crate) unit: Option<LengthUnit>,
    /// The format of the input, whatever its content and extension
    #[arg(long, value_name = "FORMAT", hide_short_help = true)]
    pub(crate) from: Option<InputFormat>,
    /// Write what was done and measured as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
    /// Fail on warnings (1), and when the result is not certified to the tolerance (3)
    #[arg(long)]
    pub(crate) strict: bool,
}

/// What the model means and how finely to convert it.
#[derive(Args, Debug)]
pub(crate) struct ModelArgs {
    /// The largest distance from the true boundary: a length in model units, or a percentage of
    /// the bounding box's diagonal [default: 0.1%]
    #[arg(short, long, value_name = "LENGTH", help_heading = "Precision")]
    pub(crate) tolerance: Option<Tolerance>,
    /// Subdivide to this level everywhere instead; three levels halve the cells
    #[arg(
        long,
        value_name = "N",
        conflicts_with = "tolerance",
        help_heading = "Precision",
        value_parser = clap::value_parser!(u8).range(0..=i64::from(subdiv::MAX_LEVEL))
    )]
    pub(crate) level: Option<u8>,
    /// Prove the topology only: components, holes, faces, edges and corners are right, however
    /// coarse the mesh. Cells as small as the tolerance that prove nothing are listed
    #[arg(long, conflicts_with = "level", help_heading = "Precision")]
    pub(crate) topology_only: bool,
    /// Deepest level that a tolerance may lead to [default: where cells are as small as it]
    #[arg(
        long,
        value_name = "N",
        conflicts_with = "level",
        hide_short_help = true,
        help_heading = "Precision",
        value_parser = clap::value_parser!(u8).range(0..=i64::from(subdiv::MAX_LEVEL))
    )]
    pub(crate) max_level: Option<u8>,
    /// How polynomials are bounded
    #[arg(
        long,
        value_name = "NAME",
        default_value = "bezier",
        hide_short_help = true,
        help_heading = "Precision"
    )]
    pub(crate) criterion: Criterion,
    /// Where facets come from
    #[arg(
        long,
        value_name = "KIND",
        default_value = "merged",
        hide_short_help = true,
        help_heading = "Precision"
    )]
    pub(crate) mesh: MeshKind,
    /// On which side of the true surfaces the facets of --mesh surfaces are
    #[arg(
        long,
        value_name = "SIDE",
        default_value = "inscribed",
        hide_short_help = true,
        help_heading = "Precision"
    )]
    pub(crate) fit: FitKind,
    /// Clip the model to this box; needed if it is unbounded
    #[arg(
        long = "box",
        num_args = 6,
        allow_negative_numbers = true,
        value_names = ["XMIN", "YMIN", "ZMIN", "XMAX", "YMAX", "ZMAX"],
        help_heading = "Model"
    )]
    pub(crate) clip: Option<Vec<f64>>,
    /// Cylinders and spheres with $fn from 1 to N are the prisms and polyhedra that OpenSCAD
    /// makes of them; with more they are round. 0 makes everything round
    #[arg(
        long,
        value_name = "N",
        default_value_t = 16,
        hide_short_help = true,
        help_heading = "Model"
    )]
    pub(crate) facet_limit: u32,
    #[command(flatten)]
    pub(crate) dialect: DialectArgs,
    /// Highest degree of a polynomial
    #[arg(
        long,
        value_name = "N",
        default_value_t = 64,
        hide_short_help = true,
        help_heading = "Limits",
        value_parser = clap::value_parser!(u8).range(1..=64)
    )]
    pub(crate) max_degree: u8,
    /// Most cells on the boundary
    #[arg(
        long,
        value_name = "N",
        default_value = "100000000",
        hide_short_help = true,
        help_heading = "Limits"
    )]
    pub(crate) max_cells: NonZeroU64,
    /// Most memory, such as 4G [default: three quarters of the machine's]
    #[arg(long, value_name = "BYTES", help_heading = "Limits")]
    pub(crate) memory: Option<Bytes>,
    /// Number of threads [default: one for each core]; the result is the same for any
    #[arg(long, value_name = "N", help_heading = "Limits")]
    pub(crate) threads: Option<NonZeroUsize>,
}

/// A model, a picture and a point of view.
#[derive(Args, Debug)]
pub(crate) struct ViewArgs {
    /// The model to read; `-` is standard input
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// The PNG picture to write, or the HTML page with a viewer in it, by the extension; `-` is
    /// standard output, for a picture
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: PathBuf,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1200x900")]
    pub(crate) size: PictureSize,
    /// Where the viewer stands: iso, front, back, left, right, top, bottom, or a direction from the
    /// model such as 1,-2,0.5
    #[arg(
        long,
        value_name = "SIDE|X,Y,Z",
        default_value = "iso",
        allow_hyphen_values = true
    )]
    pub(crate) from: Viewpoint,
    /// Show the true solid: a ray for each sample, traced through the subdivision. The mesh only
    /// casts the shadows
    #[arg(long)]
    pub(crate) raytrace: bool,
}

/// A model to describe.
#[derive(Args, Debug)]
pub(crate) struct InfoArgs {
    /// The model to read; `-` is standard input
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) clip: ClipArgs,
    #[command(flatten)]
    pub(crate) dialect: DialectArgs,
}

/// The part of space that counts.
#[derive(Args, Debug)]
pub(crate) struct ClipArgs {
    /// Clip the model to this box; needed if it is unbounded
    #[arg(
        long = "box",
        num_args = 6,
        allow_negative_numbers = true,
        value_names = ["XMIN", "YMIN", "ZMIN", "XMAX", "YMAX", "ZMAX"]
    )]
    pub(crate) corners: Option<Vec<f64>>,
}

/// A model or mesh to measure.
#[derive(Args, Debug)]
pub(crate) struct PropertiesArgs {
    /// The model to convert, or the OBJ, GLB, STL, 3MF or PLY file to measure as it is; `-` is
    /// standard input
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// A mesh file to check.
#[derive(Args, Debug)]
pub(crate) struct CheckArgs {
    /// The OBJ, GLB, STL, 3MF or PLY file; `-` is standard input
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Join vertices of exactly equal position first, whatever the file's vertex numbers say
    #[arg(long)]
    pub(crate) weld: bool,
    /// The format of the input, whatever its content and extension
    #[arg(long, value_name = "FORMAT")]
    pub(crate) from: Option<MeshInputFormat>,
    /// Most memory, such as 4G [default: three quarters of the machine's]
    #[arg(long, value_name = "BYTES")]
    pub(crate) memory: Option<Bytes>,
}

/// Reports with a schema.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum SchemaOf {
    /// What --report writes
    Convert,
    /// What check --json prints
    Check,
    /// What properties --json prints
    Properties,
}

/// Formats of meshes that can be checked and measured.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum MeshInputFormat {
    /// Wavefront OBJ
    Obj,
    /// Binary glTF
    Glb,
    /// STL, text or binary
    Stl,
    /// 3D Manufacturing Format
    #[value(name = "3mf")]
    Threemf,
    /// PLY, text or binary
    Ply,
}

/// How polynomials are bounded in a simplex.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Criterion {
    /// By their Bézier coefficients
    Bezier,
    /// By Rivlin's sharper bound
    Rivlin,
    /// By the largest gradient
    Lipschitz,
}

/// Where facets come from.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum MeshKind {
    /// From the true surfaces: as few as the tolerance asks for, after the topology is proved
    Surfaces,
    /// Those of the subdivision; planar faces have triangles between their edges only
    Merged,
    /// Those of the subdivision, one or more in each leaf
    Leaves,
}

/// Where the corners of facets lie.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum FitKind {
    /// On the true surfaces: convex ones lose volume
    Inscribed,
    /// Off them by no more than the tolerance, so that volumes are not biased
    Mean,
}

/// Formats that can be read.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum InputFormat {
    /// Flat CSG dump of OpenSCAD, with exact shapes added
    Csg,
    /// Binary Boolean tree of the thesis, .CSG
    ThesisCsg,
    /// Half-spaces of the thesis in Bézier form
    Cspg,
    /// Triangles of the thesis, stitched again
    Apl,
    /// Mesh of the thesis' renderer, stitched again
    Wfr,
}

/// Formats that can be written.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum OutputFormat {
    /// Wavefront OBJ
    Obj,
    /// Binary glTF
    Glb,
    /// Binary STL
    Stl,
    /// 3D Manufacturing Format
    #[value(name = "3mf")]
    Threemf,
    /// Binary PLY
    Ply,
    /// STEP AP242, with true surfaces
    Step,
    /// Binary Boolean tree of the thesis, .CSG: the solid itself, not its mesh
    ThesisCsg,
    /// Half-spaces of the thesis in Bézier form: the solid itself, not its mesh
    Cspg,
    /// Triangles of the thesis
    Apl,
    /// Mesh of the thesis' renderer
    Wfr,
}

/// Units of length.
#[derive(ValueEnum, Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum LengthUnit {
    /// Micrometres
    Um,
    /// Millimetres
    Mm,
    /// Centimetres
    Cm,
    /// Metres
    M,
    /// Inches
    In,
    /// Feet
    Ft,
}
