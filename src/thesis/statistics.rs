//! The statistics of a subdivision, laid out as in thesis A.3.3.3.

use subdiv::sectors::LevelCount;

/// In which language.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Language {
    English,
    Portuguese,
}

/// Title, level, totals; then the six counts of a level and of the whole.
struct Words {
    title: &'static str,
    level: &'static str,
    totals: &'static str,
    counts: [&'static str; 6],
    total_counts: [&'static str; 6],
}

const ENGLISH: Words = Words {
    title: "EXECUTION STATISTICS",
    level: "Subdivision level:",
    totals: "GRAND TOTALS:",
    counts: [
        "Simplices visited:",
        "CUT simplices:",
        "Mixed simplices:",
        "Simplices wrongly subdiv.:",
        "Primitives visited:",
        "CUT primitives:",
    ],
    total_counts: [
        "Total of simplices visited:",
        "Total of CUT simplices:",
        "Total of mixed simplices:",
        "Total of simplices wrongly subdiv.:",
        "Total of primitives visited:",
        "Total of CUT primitives:",
    ],
};

const PORTUGUESE: Words = Words {
    title: "ESTATISTICAS DE EXECUCAO",
    level: "Nivel de subdivisao:",
    totals: "TOTAIS GERAIS:",
    counts: [
        "Simplexos visitados:",
        "Simplexos CUT:",
        "Simplexos mistos:",
        "Simplexos subdiv. indev.:",
        "Primitivas visitadas:",
        "Primitivas CUT:",
    ],
    total_counts: [
        "Total de Simplexos visitados:",
        "Total de Simplexos CUT:",
        "Total de Simplexos mistos:",
        "Total de Simplexos Subdiv. Indev.:",
        "Total de Primitivas visitadas:",
        "Total de Primitivas CUT:",
    ],
};

/// `levels`: by the number of levels that are left; printed from the initial simplices down.
pub(super) fn statistics(levels: &[LevelCount], language: Language) -> String {
    let words = match language {
        Language::English => &ENGLISH,
        Language::Portuguese => &PORTUGUESE,
    };
    let mut lines = vec![words.title.to_owned(), String::new()];
    let mut whole = LevelCount::default();
    for (level, count) in levels.iter().enumerate().rev() {
        lines.push(format!("{:<28}{level}.", words.level));
        lines.extend(rows(words.counts, count));
        lines.push(String::new());
        whole.add(count);
    }
    lines.push(words.totals.to_owned());
    lines.extend(rows(words.total_counts, &whole));
    lines.join("\n") + "\n"
}

fn rows(titles: [&str; 6], count: &LevelCount) -> impl Iterator<Item = String> {
    let share = |part: u64, all: u64| {
        if all == 0 {
            0.0
        } else {
            100.0 * part as f64 / all as f64
        }
    };
    let LevelCount {
        simplices,
        cut,
        mixed,
        wasted,
        primitives,
        primitives_cut,
    } = *count;
    let numbers = [
        (simplices, 100.0),
        (cut, share(cut, simplices)),
        (mixed, share(mixed, simplices)),
        (wasted, share(wasted, simplices)),
        (primitives, 100.0),
        (primitives_cut, share(primitives_cut, primitives)),
    ];
    let width = if titles[0].len() > 24 { 36 } else { 28 };
    let rows = titles.map(str::to_owned).into_iter().zip(numbers);
    rows.map(move |(title, (number, share))| format!("{title:<width$}{number} ({share:.1}%)."))
}
