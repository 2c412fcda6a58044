//! Everything that is said to people: errors, warnings and remarks, on standard error.

use crate::args::{ColorChoice, TalkArgs};
use crate::excerpt::Excerpt;
use crate::failure::Failure;
use io::read::Diagnostic;
use miette::{GraphicalReportHandler, GraphicalTheme, Severity};
use std::io::{IsTerminal as _, Write as _};

/// The voice of the program: how much it says, and in which colours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Talk {
    quiet: bool,
    verbose: bool,
    colored: bool,
}

impl Talk {
    pub(crate) fn new(args: TalkArgs) -> Self {
        let colored = match args.color {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => {
                let no_color = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
                !no_color && std::io::stderr().is_terminal()
            }
        };
        Self {
            quiet: args.quiet,
            verbose: args.verbose,
            colored,
        }
    }

    pub(crate) fn is_quiet(self) -> bool {
        self.quiet
    }

    /// What a run says when it is done.
    pub(crate) fn say(self, text: &str) {
        if !self.quiet {
            print(text);
        }
    }

    /// What only the curious want to know.
    pub(crate) fn explain(self, text: impl FnOnce() -> String) {
        if self.verbose {
            print(&text());
        }
    }

    /// Something about the model that its author may not expect.
    pub(crate) fn warn(self, text: &str) {
        if !self.quiet {
            print(&format!("{} {text}", self.painted("warning:", "33")));
        }
    }

    /// The same, about a place in its text.
    pub(crate) fn warn_about(self, diagnostic: &Diagnostic, source: &str) {
        if !self.quiet {
            print(&self.drawn(diagnostic, source, Severity::Warning));
        }
    }

    /// Why the program fails.
    pub(crate) fn fail(self, failure: &Failure) {
        match failure {
            Failure::BrokenPipe => {}
            Failure::Diagnostics {
                diagnostics,
                source,
            } => {
                for diagnostic in diagnostics.as_slice() {
                    print(&self.drawn(diagnostic, source, Severity::Error));
                }
            }
            _ => print(&format!("{} {failure}", self.painted("error:", "31"))),
        }
    }

    fn painted(self, text: &str, color: &str) -> String {
        if self.colored {
            format!("\x1b[1;{color}m{text}\x1b[0m")
        } else {
            text.to_owned()
        }
    }

    /// `error: part.csg:1:1: message`, then the line with the place marked, then the remedy.
    fn drawn(self, diagnostic: &Diagnostic, source: &str, severity: Severity) -> String {
        let title = match severity {
            Severity::Error => self.painted("error:", "31"),
            _ => self.painted("warning:", "33"),
        };
        let Diagnostic {
            file, line, column, ..
        } = diagnostic;
        let title = format!("{title} {file}:{line}:{column}: {}", diagnostic.message);
        let excerpt = Excerpt::new(diagnostic, source, severity);
        if excerpt.is_blank() {
            return match &diagnostic.remedy {
                Some(remedy) => format!("{title}\n  help: {remedy}"),
                None => title,
            };
        }
        let theme = if self.colored {
            GraphicalTheme::unicode()
        } else {
            GraphicalTheme::unicode_nocolor()
        };
        let mut drawing = String::new();
        let drawn = GraphicalReportHandler::new_themed(theme)
            .with_width(100)
            .with_wrap_lines(false)
            .render_report(&mut drawing, &excerpt);
        // The drawing begins with the message, which the title has said in a form that editors
        // and other programs recognise.
        let body = drawing.find('╭').and_then(|corner| {
            let start = drawing.get(..corner)?.rfind('\n')? + 1;
            drawing.get(start..)
        });
        match body {
            Some(body) if drawn.is_ok() => format!("{title}\n{}", body.trim_end()),
            _ => title,
        }
    }
}

/// One line or several on standard error; nobody is left to be told if that fails.
fn print(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}
