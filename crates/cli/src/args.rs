//! The words that are understood.
//!
//! Knows flags and their help. Does not know what they lead to.

use crate::water_arguments::WaterArguments;
use clap::{Arg, Args, CommandFactory, Parser, Subcommand, ValueEnum};
use pontoon_plan::job::Shard;
use pontoon_plan::study_file::ModelSpec;
use std::any::TypeId;
use std::fmt;
use std::path::PathBuf;

/// Parametric studies of the hydroelastic response of floating ribbon bridges.
///
/// Exit status: 0 all good; 1 done, but something fell short (a failed job, a check); 2 input refused; 3 could not go on; 130 interrupted.
#[derive(Debug, Parser)]
#[command(
    name = "pontoon",
    version,
    propagate_version = true,
    after_help = "Example:\n  pontoon run studies/fu2005      runs a study and writes its tables to results/fu2005"
)]
pub(crate) struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

impl Arguments {
    /// The words as they are understood. A number may be negative, so that it is refused by its range and not as a flag.
    pub(crate) fn words() -> clap::Command {
        let words = Self::command();
        let names: Vec<String> = words.get_subcommands().map(|sub| sub.get_name().to_owned()).collect();
        let numbers = |arg: Arg| {
            if is_number(&arg) {
                arg.allow_negative_numbers(true)
            } else {
                arg
            }
        };
        names.into_iter().fold(words, |words, name| {
            words.mut_subcommand(name, |sub| sub.mut_args(numbers))
        })
    }
}

/// Whether the value of an argument is a number.
fn is_number(arg: &Arg) -> bool {
    let of = arg.get_value_parser().type_id();
    [TypeId::of::<u16>(), TypeId::of::<usize>(), TypeId::of::<f64>()]
        .iter()
        .any(|number| of == *number)
}

/// A count or the number of something.
fn whole(text: &str) -> Result<usize, NotWhole> {
    text.parse().map_err(|_| NotWhole)
}

/// A text that is no whole number of at least 0.
#[derive(Debug)]
struct NotWhole;

impl std::error::Error for NotWhole {}

impl fmt::Display for NotWhole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("allowed: a whole number of at least 0")
    }
}

/// What every command takes.
#[derive(Debug, Clone, Copy, Args)]
pub(crate) struct Common {
    /// How to write results on standard output.
    #[arg(long, global = true, value_enum, default_value_t = Format::Text)]
    pub format: Format,
    /// No progress and no notes on standard error; errors and failed jobs remain.
    #[arg(long, short, global = true)]
    pub quiet: bool,
}

/// How results are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// For people.
    Text,
    /// For programs.
    Json,
    /// A comparison as a Markdown table, for a CI summary.
    Markdown,
    /// A comparison as JUnit XML, for a CI server.
    Junit,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Runs a study and writes its tables.
    ///
    /// Every job is checked before anything runs or is written. Jobs run in parallel; a job that fails is a row with its
    /// reason, the others go on. What a job leaves is kept in a journal at once: after a kill, a crash or an interrupt the same
    /// command runs what is missing. The folder of results then holds jobs.parquet, summary.csv, manifest.json and the tables that
    /// the study keeps, such as positions.parquet, connectors.parquet, limits.parquet and histories.parquet.
    #[command(
        after_help = "Examples:\n  pontoon run studies/fu2005\n  pontoon run studies/smoke --out /tmp/smoke --threads 2 --format json"
    )]
    Run(RunArguments),
    /// Says which vehicle may cross how: one crossing a cell, with its utilisation and the limit that governs.
    ///
    /// The study has limits and grids, most often with an axis of vehicles. Where a grid has no axis crossing_type, it gets all three:
    /// normal, a column 30.5 m from tail to head, at the speeds of the grid, or at 2, 4 and 6 m/s where it has none; caution, 45.7 m from
    /// tail to head on the centre line at 3.6 m/s; risk, one vehicle on the centre line at 1.3 m/s. Speeds of the grid are those of normal
    /// crossings alone. Nothing is searched. Results are those of a study named NAME_classes. Exit status 1 where a crossing failed.
    #[command(after_help = "Example:\n  pontoon rate studies/rating")]
    Rate(RateArguments),
    /// Says what would run: jobs, distinct bridges, steps, expected time; of a folder of results what is done, missing,
    /// failed. Writes nothing.
    #[command(after_help = "Example:\n  pontoon plan studies/fu2005")]
    Plan(PlanArguments),
    /// Says how far runs have come, while they run or after: jobs done, missing, failed.
    #[command(after_help = "Example:\n  pontoon status results/fu2005/shards/* --format json")]
    Status(StatusArguments),
    /// Says why a job ran or will run.
    #[command(after_help = "Example:\n  pontoon explain results/fu2005 7")]
    Explain(ExplainArguments),
    /// Puts the shards of a study together.
    ///
    /// Refuses shards of different studies or versions, records that contradict each other, and shards that leave jobs out.
    /// The tables are those of a run of the whole study, byte for byte.
    #[command(after_help = "Example:\n  pontoon merge results/fu2005/shards/* --out results/fu2005")]
    Merge(MergeArguments),
    /// Natural frequencies with the name of each shape.
    ///
    /// The bridge floats free, linearly connected, unless told otherwise.
    #[command(
        after_help = "Examples:\n  pontoon modes studies/bridges/fu2005.json --count 20\n  pontoon modes studies/bridges/fu2005.json --module --count 6"
    )]
    Modes(ModesArguments),
    /// Compares results with a reference file, or with older results job by job.
    ///
    /// A line a check: what is expected, what was found, by how much it is off, how much was left, the verdict. Exit status
    /// 1 where a check falls short; one that matches no row, or failed jobs only, falls short too. Older results are
    /// matched by the axes of their jobs.
    #[command(
        after_help = "Examples:\n  pontoon compare results/table1 --with studies/table1/reference.json\n  pontoon compare results/fu2005 --with results/fu2005-old --tolerance tolerance.json --format junit"
    )]
    Compare(CompareArguments),
    /// Says which axes an output hangs on: Sobol' indices and elementary effects.
    ///
    /// The study has a design `saltelli`, from which come first orders, totals and, where it asks for them, second orders; or a design
    /// `morris`, from which come mu, mu_star and sigma. Half widths of 95 % intervals stand beside them. Points of one row of the base
    /// sample, or of one trajectory, belong together: where a job of them failed or left no number, they are left out, and how many were is
    /// told with each output. Exit status 1 where a job failed.
    #[command(
        after_help = "Examples:\n  pontoon indices results/gaps\n  pontoon indices results/gaps --of peak_deflection_m --of peak_compression_n --format json"
    )]
    Indices(IndicesArguments),
    /// Identifies numbers of a bridge by a bounded least-squares fit to the checks of references.
    ///
    /// The parameters file names what may move and between which bounds, what is held, and which checks are fitted; each
    /// reference names the study that gives what its checks look at. Writes the bridge found, with its provenance.
    /// Exit status 1 where the search did not come to its end.
    #[command(
        after_help = "Example:\n  pontoon calibrate studies/identification/start.json --with studies/table1 --with studies/fig09_static --parameters studies/identification/parameters.json --out bridge.json"
    )]
    Calibrate(CalibrateArguments),
    /// Shows results: one page that opens anywhere, figures for papers.
    ///
    /// The page is one HTML file that carries all it needs: summary, peaks against speed, heat maps, envelope, histories, a
    /// browser of jobs that plays their crossings, mode shapes and, with a reference, the experiment's points and the
    /// verdicts. A folder whose run is not done gives a page of what is there. Figures are deflected lines, histories, peaks
    /// against speed, envelopes, frequencies, each of jobs that differ in one axis alone. Exit status 1 where a check falls
    /// short or a job failed.
    #[command(
        after_help = "Examples:\n  pontoon report results/fig09_static --with studies/fig09_static\n  pontoon report results/fu2005 --out fu2005.html\n  pontoon report results/fig09_static --with studies/fig09_static --figures figures/fig09_static"
    )]
    Report(ReportArguments),
    /// Mode shapes, static cases and crossings as VTK files for ParaView.
    ///
    /// Of a bridge file its mode shapes and, where a load is given, a static case; of results a job's mode shapes and its static
    /// case or crossing, which is solved again. Open the .pvd files. The folder is there whole afterwards, or as it was before.
    #[command(
        after_help = "Examples:\n  pontoon export studies/bridges/fu2005.json --to vtk --load-n 230300 --load-position 7\n  pontoon export results/fu2005 --to vtk --job 20 --count 0 --stresses"
    )]
    Export(ExportArguments),
    /// Reads added mass and radiation damping of a chain of modules from a file of a BEM code and checks them.
    ///
    /// Files of Capytaine (netCDF), WAMIT (.1, with .hst beside it) and NEMOH, and water files. What they do not hold has to be told.
    /// Exit status 1 where a check refuses the water; it is not written then.
    #[command(
        after_help = "Examples:\n  pontoon water ribbon.nc --bridge studies/bridges/fu2005.json --out water.json\n  pontoon water chain.1 --bridge bridge.json --depth-m 4 --density-kg-m3 1000 --gravity-m-s2 9.81"
    )]
    Water(WaterArguments),
    /// The JSON Schema of a file, for an editor or a checker; the columns of tables.
    #[command(after_help = "Example:\n  pontoon schema study > study.schema.json")]
    Schema(SchemaArguments),
    /// Writes what makes a shell complete the words of this program.
    #[command(
        after_help = "Examples:\n  pontoon completions bash > ~/.local/share/bash-completion/completions/pontoon\n  pontoon completions zsh > ~/.zfunc/_pontoon\n  pontoon completions fish > ~/.config/fish/completions/pontoon.fish"
    )]
    Completions(CompletionsArguments),
    /// Writes manual pages, one a command.
    #[command(after_help = "Example:\n  pontoon man --to ~/.local/share/man/man1      then: man pontoon-run")]
    Man(ManArguments),
}

/// What `rate` takes.
#[derive(Debug, Args)]
pub(crate) struct RateArguments {
    /// The study: a study.json or the folder that holds it.
    #[arg(value_name = "STUDY")]
    pub study: PathBuf,
    /// Folder of the results; `results/<study name>_classes` where absent.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Threads; as many as the machine has where absent. The table does not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Moves results that the folder holds to a folder `aside` in it, and begins anew.
    #[arg(long)]
    pub fresh: bool,
}

/// What `run` takes.
#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    /// The study: a study.json or the folder that holds it.
    #[arg(value_name = "STUDY")]
    pub study: PathBuf,
    /// Folder of the results; `results/<study name>` where absent. Its own tables are replaced; results of another study are
    /// not.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Threads; as many as the machine has where absent. The tables do not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Runs a share of the jobs alone, K from 0 to N - 1, into `results/<study name>/shards/K-of-N` unless --out says
    /// otherwise; `merge` puts shares together.
    #[arg(long, value_name = "K/N", conflicts_with = "with")]
    pub shard: Option<Shard>,
    /// Moves results that the folder holds to a folder `aside` in it, and begins anew.
    #[arg(long)]
    pub fresh: bool,
    /// Tries recorded jobs that failed again, as after a lack of memory; the others are not run again.
    #[arg(long, conflicts_with = "fresh")]
    pub retry_failed: bool,
    /// Stops when more jobs than this have failed.
    #[arg(long, value_name = "N", value_parser = whole)]
    pub max_failures: Option<usize>,
    /// Takes records that were computed on other instruction paths for its own.
    #[arg(long)]
    pub any_instructions: bool,
    /// Jobs to be solved one by one into the journal of a folder that another process holds.
    #[arg(long, hide = true, value_parser = apart, value_name = "HASH:JOB,...")]
    pub apart: Option<(String, Vec<usize>)>,
    /// Prepares the bridges of these jobs one by one, and solves none.
    #[arg(long, hide = true, requires = "apart")]
    pub prepare_only: bool,
    /// Compares the results with a reference file (or the folder that holds reference.json) once they are there.
    #[arg(long, value_name = "REFERENCE")]
    pub with: Option<PathBuf>,
}

/// Hash of a study and numbers of its jobs.
fn apart(text: &str) -> Result<(String, Vec<usize>), NotApart> {
    let (hash, jobs) = text.split_once(':').ok_or(NotApart)?;
    let jobs: Result<_, _> = jobs.split(',').map(str::parse).collect();
    Ok((hash.to_owned(), jobs.map_err(|_| NotApart)?))
}

/// A text that names no jobs of a study.
#[derive(Debug)]
struct NotApart;

impl std::error::Error for NotApart {}

impl fmt::Display for NotApart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("HASH:JOB,...")
    }
}

/// What `status` takes.
#[derive(Debug, Args)]
pub(crate) struct StatusArguments {
    /// Folders of results, or of shards.
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,
}

/// What `explain` takes.
#[derive(Debug, Args)]
pub(crate) struct ExplainArguments {
    /// Folder of results, or of a shard.
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Number of the job, from 0.
    #[arg(value_name = "JOB", value_parser = whole)]
    pub job: usize,
}

/// What `merge` takes.
#[derive(Debug, Args)]
pub(crate) struct MergeArguments {
    /// Folders of the shards.
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,
    /// Folder of the results.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Takes shards that were computed on different instruction paths; the tables then say so.
    #[arg(long)]
    pub any_instructions: bool,
}

/// What `compare` takes.
#[derive(Debug, Args)]
pub(crate) struct CompareArguments {
    /// Folder of the results.
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,
    /// A reference file, the folder that holds reference.json, or a folder of older results.
    #[arg(long, value_name = "REFERENCE|OLD_RESULTS")]
    pub with: PathBuf,
    /// How far columns may be from older results: {"default": {"relative_tolerance": 1e-6}, "columns": {"NAME": ...}}.
    #[arg(long, value_name = "FILE")]
    pub tolerance: Option<PathBuf>,
}

/// What `indices` takes.
#[derive(Debug, Args)]
pub(crate) struct IndicesArguments {
    /// Folder of the results.
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,
    /// A column of numbers of the table of jobs; may be given several times. All measures that hold numbers where absent.
    #[arg(long, value_name = "COLUMN")]
    pub of: Vec<String>,
    /// How often rows or trajectories are drawn again for the intervals.
    #[arg(long, value_name = "N", default_value_t = 1000, value_parser = clap::value_parser!(u16).range(2..=10_000))]
    pub resamples: u16,
    /// Equal seeds give equal intervals. The indices do not depend on it.
    #[arg(long, value_name = "S", default_value_t = 1, value_parser = whole)]
    pub seed: usize,
}

/// What `report` takes.
#[derive(Debug, Args)]
pub(crate) struct ReportArguments {
    /// Folder of the results, or of a run that is not done.
    #[arg(value_name = "RESULTS")]
    pub results: PathBuf,
    /// A reference file or the folder that holds reference.json: its points are drawn, its checks are judged.
    #[arg(long, value_name = "REFERENCE")]
    pub with: Option<PathBuf>,
    /// The page to write; `report.html` in the folder of results where absent. A file there is replaced where it is a page
    /// of this program.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Crossings that can be played, at most; they are solved once more.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u16).range(0..=400))]
    pub plays: u16,
    /// Folder to write figures for papers into: SVG, PNG, their captions in figures.md, the numbers plotted in figures.json.
    /// Earlier figures there are replaced, other files left alone.
    /// The page is then written where --out asks for it.
    #[arg(long, value_name = "DIR")]
    pub figures: Option<PathBuf>,
}

/// What `calibrate` takes.
#[derive(Debug, Args)]
pub(crate) struct CalibrateArguments {
    /// The bridge to start from.
    #[arg(value_name = "BRIDGE")]
    pub bridge: PathBuf,
    /// A reference file, or the folder that holds reference.json; may be given several times.
    #[arg(long, value_name = "REFERENCE", required = true)]
    pub with: Vec<PathBuf>,
    /// The file of parameters.
    #[arg(long, value_name = "FILE")]
    pub parameters: PathBuf,
    /// The bridge file to write.
    #[arg(long, value_name = "BRIDGE")]
    pub out: PathBuf,
    /// Threads; as many as the machine has where absent. The bridge does not depend on it.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}

/// What `plan` takes.
#[derive(Debug, Args)]
pub(crate) struct PlanArguments {
    /// The study: a study.json or the folder that holds it.
    #[arg(value_name = "STUDY")]
    pub study: PathBuf,
    /// Folder of results to look into; `results/<study name>` where absent.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What `modes` takes.
#[derive(Debug, Args)]
pub(crate) struct ModesArguments {
    /// The bridge file.
    #[arg(value_name = "BRIDGE")]
    pub bridge: PathBuf,
    /// Model of the modules.
    #[arg(long, value_enum, default_value_t = ModelArgument::Full)]
    pub model: ModelArgument,
    /// How many modes, from the lowest.
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub count: u16,
    /// The bridge on its supports in place of floating free.
    #[arg(long, conflicts_with = "module")]
    pub supports: bool,
    /// A single module floating alone in place of the bridge.
    #[arg(long)]
    pub module: bool,
}

/// Model of the modules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModelArgument {
    /// Every degree of freedom of the shells and beams.
    Full,
    /// The condensed module.
    SuperElement,
}

impl From<ModelArgument> for ModelSpec {
    fn from(model: ModelArgument) -> Self {
        match model {
            ModelArgument::Full => Self::Full,
            ModelArgument::SuperElement => Self::SuperElement,
        }
    }
}

/// What `export` takes.
#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    /// A folder of results or a bridge file.
    #[arg(value_name = "RESULTS|BRIDGE")]
    pub source: PathBuf,
    /// Folder to write: one that is not there, is empty or holds an earlier export.
    #[arg(long, value_name = "DIR")]
    pub to: PathBuf,
    /// How many modes, from the lowest; 0: none. What a study of modes asks for, 20 otherwise, where absent.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=1000))]
    pub count: Option<u16>,
    /// Modes of the bridge on its supports in place of floating free.
    #[arg(long)]
    pub supports: bool,
    /// Weight of a vehicle that stands on the bridge, in N: a static case. The vehicle is the study's, a single footprint of
    /// 3.35 m on two tracks of a bridge file.
    #[arg(long, value_name = "N")]
    pub load_n: Option<f64>,
    /// Place of its centre, in m.
    #[arg(long, value_name = "X", requires = "load_n", conflicts_with = "load_position")]
    pub load_x_m: Option<f64>,
    /// Position of its centre, 1 to modules + 1.
    #[arg(long, value_name = "P", requires = "load_n", value_parser = whole)]
    pub load_position: Option<usize>,
    /// How the connectors work under it; nonlinear where absent.
    #[arg(long, value_enum, requires = "load_n")]
    pub connection: Option<ConnectionArgument>,
    /// Tension gap under it, in m; the bridge's where absent.
    #[arg(long, value_name = "X", requires = "load_n")]
    pub gap_tension_m: Option<f64>,
    /// Compression gap under it, in m; the bridge's where absent.
    #[arg(long, value_name = "X", requires = "load_n")]
    pub gap_compression_m: Option<f64>,
    /// Number of the job, from 0; the one with the largest deflection where absent.
    #[arg(long, value_name = "N", value_parser = whole)]
    pub job: Option<usize>,
    /// Time steps from one instant of a crossing to the next; as many as give about 20 instants a second where absent.
    #[arg(long, value_name = "K", value_parser = whole)]
    pub every: Option<usize>,
    /// Writes stresses of plates and forces of stiffeners too: of the static case, of each instant of a crossing, and the
    /// largest von Mises stress of each shell over all time steps of the crossing. Mode shapes have none.
    #[arg(long)]
    pub stresses: bool,
}

/// How connectors work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ConnectionArgument {
    /// Both trusses at once, without gaps.
    Linear,
    /// Each truss behind its gap.
    Nonlinear,
}

/// What `schema` takes.
#[derive(Debug, Args)]
pub(crate) struct SchemaArguments {
    /// Of which file.
    #[arg(value_enum)]
    pub of: SchemaOf,
}

/// The files that have a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SchemaOf {
    /// A study file.
    Study,
    /// A bridge file.
    Bridge,
    /// A vehicle file.
    Vehicle,
    /// A water file.
    Water,
    /// A reference file.
    Reference,
    /// A file of parameters for `calibrate`.
    Parameters,
    /// The tables of results: no schema, but each column and each axis of a name with its unit and what it is.
    Tables,
}

/// What `completions` takes.
#[derive(Debug, Args)]
pub(crate) struct CompletionsArguments {
    /// Of which shell.
    #[arg(value_enum, value_name = "SHELL")]
    pub shell: clap_complete::Shell,
}

/// What `man` takes.
#[derive(Debug, Args)]
pub(crate) struct ManArguments {
    /// Folder of the pages; made where it is missing. Pages of the same names are replaced.
    #[arg(long, value_name = "DIR")]
    pub to: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn every_command_has_an_example_and_is_well_formed() {
        let mut command = Arguments::command();
        command.clone().debug_assert();
        for sub in command.get_subcommands_mut() {
            let help = sub.render_long_help().to_string();
            assert!(help.contains("Example"), "{help}");
        }
    }

    #[test]
    fn every_number_may_be_negative_and_is_then_refused_as_a_number() {
        let words = Arguments::words();
        let mut numbers = 0;
        for sub in words.get_subcommands() {
            for arg in sub.get_arguments().filter(|arg| is_number(arg)) {
                assert!(arg.is_allow_negative_numbers_set(), "{} {arg}", sub.get_name());
                numbers += 1;
            }
        }
        assert!(numbers >= 13, "{numbers}");
        for (line, told) in [
            (
                "export b.json --to v --load-n 1e5 --load-position -1",
                "'-1' for '--load-position <P>': allowed: a whole",
            ),
            (
                "export b.json --to v --count -1",
                "'-1' for '--count <N>': -1 is not in 0..=1000",
            ),
            ("run s --threads -2", "'-2' for '--threads <N>': -2 is not in 1..=1024"),
            (
                "run s --max-failures -2",
                "'-2' for '--max-failures <N>': allowed: a whole number of at least 0",
            ),
            (
                "explain r -1",
                "'-1' for '<JOB>': allowed: a whole number of at least 0",
            ),
        ] {
            let refused = Arguments::words().try_get_matches_from(format!("pontoon {line}").split(' '));
            let message = refused.unwrap_err().to_string();
            assert!(message.contains(&format!("invalid value {told}")), "{message}");
        }
        let taken = "pontoon export b.json --to v --load-n -1e5 --load-x-m -1 --gap-tension-m -0.5";
        assert!(Arguments::words().try_get_matches_from(taken.split(' ')).is_ok());
    }
}
