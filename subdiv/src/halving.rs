//! De Casteljau at the midpoint of the refinement edge: one Bernstein form into its two children.
//!
//! The recurrence b^r_ijkl = ½ b^{r-1}_{i+1,jkl} + ½ b^{r-1}_{ijk,l+1} (thesis 4.4.1; the exponents
//! there are misprinted) never mixes different (j, k): each pair is a univariate Bernstein form
//! of degree s = n−j−k along v0–v3. Its left edge b^r_{s−r,jk0} is the near child's coefficient
//! (s−r, r, j, k) and its right edge b^r_{0jk,s−r} the far child's (s−r, r, k, j) for type 0 and
//! (s−r, r, j, k) for types 1 and 2, whose vertices are listed in [`crate::simplex`].
//!
//! The sum is symmetric, so a facet gets identical bits from both sides. Each of the n averages
//! rounds once. Degrees 1 to 6 are written out: loops over tables were several times slower.

use crate::bernstein::index;

/// Halves a Bernstein polynomial at the midpoint of its refinement edge v0–v3.
///
/// `parent`: the coefficients in storage order. Fills `near` (child holding v0) and `far` (child
/// holding v3), same length and order. `kind` is the parent's type, 0, 1 or 2.
pub(crate) fn halve(degree: usize, kind: u8, parent: &[f64], near: &mut [f64], far: &mut [f64]) {
    match (degree, kind) {
        (1, 0) => straight_1_swapped(parent, near, far),
        (1, _) => straight_1(parent, near, far),
        (2, 0) => straight_2_swapped(parent, near, far),
        (2, _) => straight_2(parent, near, far),
        (3, 0) => straight_3_swapped(parent, near, far),
        (3, _) => straight_3(parent, near, far),
        (4, 0) => straight_4_swapped(parent, near, far),
        (4, _) => straight_4(parent, near, far),
        (5, 0) => straight_5_swapped(parent, near, far),
        (5, _) => straight_5(parent, near, far),
        (6, 0) => straight_6_swapped(parent, near, far),
        (6, _) => straight_6(parent, near, far),
        _ => halve_any_degree(degree, kind, parent, near, far),
    }
}

/// The same for any degree.
fn halve_any_degree(n: usize, kind: u8, parent: &[f64], near: &mut [f64], far: &mut [f64]) {
    let mut line = [0.0; 65];
    for j in 0..=n {
        for k in 0..=n - j {
            let s = n - j - k;
            for l in 0..=s {
                line[l] = parent[index(j, k, l)];
            }
            for r in 0..=s {
                let (x, y) = if kind == 0 { (k, j) } else { (j, k) };
                near[index(r, j, k)] = line[0];
                far[index(r, x, y)] = line[s - r];
                for l in 0..s - r {
                    line[l] = 0.5 * (line[l] + line[l + 1]);
                }
            }
        }
    }
}

/// One univariate line: positions of its coefficients in parent, near and far child.
macro_rules! line {
    ($p:ident $n:ident $f:ident; $a:literal; $r0:literal; $q0:literal) => {
        $n[$r0] = $p[$a];
        $f[$q0] = $p[$a];
    };
    ($p:ident $n:ident $f:ident; $a:literal $b:literal; $r0:literal $r1:literal; $q0:literal $q1:literal) => {
        let (a, b) = ($p[$a], $p[$b]);
        let m = 0.5 * (a + b);
        ($n[$r0], $n[$r1]) = (a, m);
        ($f[$q0], $f[$q1]) = (b, m);
    };
    ($p:ident $n:ident $f:ident; $a:literal $b:literal $c:literal; $r0:literal $r1:literal $r2:literal; $q0:literal $q1:literal $q2:literal) => {
        let (a, b, c) = ($p[$a], $p[$b], $p[$c]);
        let (ab, bc) = (0.5 * (a + b), 0.5 * (b + c));
        let m = 0.5 * (ab + bc);
        ($n[$r0], $n[$r1], $n[$r2]) = (a, ab, m);
        ($f[$q0], $f[$q1], $f[$q2]) = (c, bc, m);
    };
    ($p:ident $n:ident $f:ident; $a:literal $b:literal $c:literal $d:literal; $r0:literal $r1:literal $r2:literal $r3:literal; $q0:literal $q1:literal $q2:literal $q3:literal) => {
        let (a, b, c, d) = ($p[$a], $p[$b], $p[$c], $p[$d]);
        let (ab, bc, cd) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d));
        let (abc, bcd) = (0.5 * (ab + bc), 0.5 * (bc + cd));
        let m = 0.5 * (abc + bcd);
        ($n[$r0], $n[$r1], $n[$r2], $n[$r3]) = (a, ab, abc, m);
        ($f[$q0], $f[$q1], $f[$q2], $f[$q3]) = (d, cd, bcd, m);
    };
    ($p:ident $n:ident $f:ident; $a:literal $b:literal $c:literal $d:literal $e:literal; $r0:literal $r1:literal $r2:literal $r3:literal $r4:literal; $q0:literal $q1:literal $q2:literal $q3:literal $q4:literal) => {
        let (a, b, c, d, e) = ($p[$a], $p[$b], $p[$c], $p[$d], $p[$e]);
        let (ab, bc, cd, de) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + d), 0.5 * (d + e));
        let (abc, bcd, cde) = (0.5 * (ab + bc), 0.5 * (bc + cd), 0.5 * (cd + de));
        let (abcd, bcde) = (0.5 * (abc + bcd), 0.5 * (bcd + cde));
        let m = 0.5 * (abcd + bcde);
        ($n[$r0], $n[$r1], $n[$r2], $n[$r3], $n[$r4]) = (a, ab, abc, abcd, m);
        ($f[$q0], $f[$q1], $f[$q2], $f[$q3], $f[$q4]) = (e, de, cde, bcde, m);
    };
    ($p:ident $n:ident $f:ident; $a0:literal $a1:literal $a2:literal $a3:literal $a4:literal $a5:literal; $r0:literal $r1:literal $r2:literal $r3:literal $r4:literal $r5:literal; $q0:literal $q1:literal $q2:literal $q3:literal $q4:literal $q5:literal) => {
        let (a, b, c, d, e, f) = ($p[$a0], $p[$a1], $p[$a2], $p[$a3], $p[$a4], $p[$a5]);
        let (ab, bc, cd, de, ef) = (
            0.5 * (a + b),
            0.5 * (b + c),
            0.5 * (c + d),
            0.5 * (d + e),
            0.5 * (e + f),
        );
        let (abc, bcd, cde, def) = (
            0.5 * (ab + bc),
            0.5 * (bc + cd),
            0.5 * (cd + de),
            0.5 * (de + ef),
        );
        let (abcd, bcde, cdef) = (0.5 * (abc + bcd), 0.5 * (bcd + cde), 0.5 * (cde + def));
        let (abcde, bcdef) = (0.5 * (abcd + bcde), 0.5 * (bcde + cdef));
        let m = 0.5 * (abcde + bcdef);
        ($n[$r0], $n[$r1], $n[$r2], $n[$r3], $n[$r4], $n[$r5]) = (a, ab, abc, abcd, abcde, m);
        ($f[$q0], $f[$q1], $f[$q2], $f[$q3], $f[$q4], $f[$q5]) = (f, ef, def, cdef, bcdef, m);
    };
    ($p:ident $n:ident $f:ident; $a0:literal $a1:literal $a2:literal $a3:literal $a4:literal $a5:literal $a6:literal; $r0:literal $r1:literal $r2:literal $r3:literal $r4:literal $r5:literal $r6:literal; $q0:literal $q1:literal $q2:literal $q3:literal $q4:literal $q5:literal $q6:literal) => {
        let (a, b, c, d, e, f, g) = (
            $p[$a0], $p[$a1], $p[$a2], $p[$a3], $p[$a4], $p[$a5], $p[$a6],
        );
        let (ab, bc, cd, de, ef, fg) = (
            0.5 * (a + b),
            0.5 * (b + c),
            0.5 * (c + d),
            0.5 * (d + e),
            0.5 * (e + f),
            0.5 * (f + g),
        );
        let (abc, bcd, cde, def, efg) = (
            0.5 * (ab + bc),
            0.5 * (bc + cd),
            0.5 * (cd + de),
            0.5 * (de + ef),
            0.5 * (ef + fg),
        );
        let (abcd, bcde, cdef, defg) = (
            0.5 * (abc + bcd),
            0.5 * (bcd + cde),
            0.5 * (cde + def),
            0.5 * (def + efg),
        );
        let (abcde, bcdef, cdefg) = (
            0.5 * (abcd + bcde),
            0.5 * (bcde + cdef),
            0.5 * (cdef + defg),
        );
        let (abcdef, bcdefg) = (0.5 * (abcde + bcdef), 0.5 * (bcdef + cdefg));
        let m = 0.5 * (abcdef + bcdefg);
        (
            $n[$r0], $n[$r1], $n[$r2], $n[$r3], $n[$r4], $n[$r5], $n[$r6],
        ) = (a, ab, abc, abcd, abcde, abcdef, m);
        (
            $f[$q0], $f[$q1], $f[$q2], $f[$q3], $f[$q4], $f[$q5], $f[$q6],
        ) = (g, fg, efg, defg, cdefg, bcdefg, m);
    };
}

/// Defines one degree and far-child order; the positions are those that `index` gives, which
/// the tests compare with [`halve_any_degree`].
macro_rules! straight {
    ($name:ident $count:literal $({ $($a:literal)+; $($r:literal)+; $($q:literal)+ })+) => {
        fn $name(parent: &[f64], near: &mut [f64], far: &mut [f64]) {
            let (Some(p), Some(n), Some(f)) = (
                parent.first_chunk::<$count>(),
                near.first_chunk_mut::<$count>(),
                far.first_chunk_mut::<$count>(),
            ) else {
                debug_assert!(false, "coefficient lists shorter than the degree asks for");
                return;
            };
            $( line!(p n f; $($a)+; $($r)+; $($q)+); )+
        }
    };
}

straight! { straight_1_swapped 4
    { 0 3; 0 1; 0 1 }
    { 2; 3; 2 }
    { 1; 2; 3 }
}
straight! { straight_1 4
    { 0 3; 0 1; 0 1 }
    { 2; 3; 3 }
    { 1; 2; 2 }
}
straight! { straight_2_swapped 10
    { 0 3 9; 0 1 4; 0 1 4 }
    { 2 8; 3 6; 2 5 }
    { 7; 9; 7 }
    { 1 6; 2 5; 3 6 }
    { 5; 8; 8 }
    { 4; 7; 9 }
}
straight! { straight_2 10
    { 0 3 9; 0 1 4; 0 1 4 }
    { 2 8; 3 6; 3 6 }
    { 7; 9; 9 }
    { 1 6; 2 5; 2 5 }
    { 5; 8; 8 }
    { 4; 7; 7 }
}
straight! { straight_3_swapped 20
    { 0 3 9 19; 0 1 4 10; 0 1 4 10 }
    { 2 8 18; 3 6 12; 2 5 11 }
    { 7 17; 9 15; 7 13 }
    { 16; 19; 16 }
    { 1 6 15; 2 5 11; 3 6 12 }
    { 5 14; 8 14; 8 14 }
    { 13; 18; 17 }
    { 4 12; 7 13; 9 15 }
    { 11; 17; 18 }
    { 10; 16; 19 }
}
straight! { straight_3 20
    { 0 3 9 19; 0 1 4 10; 0 1 4 10 }
    { 2 8 18; 3 6 12; 3 6 12 }
    { 7 17; 9 15; 9 15 }
    { 16; 19; 19 }
    { 1 6 15; 2 5 11; 2 5 11 }
    { 5 14; 8 14; 8 14 }
    { 13; 18; 18 }
    { 4 12; 7 13; 7 13 }
    { 11; 17; 17 }
    { 10; 16; 16 }
}
straight! { straight_4_swapped 35
    { 0 3 9 19 34; 0 1 4 10 20; 0 1 4 10 20 }
    { 2 8 18 33; 3 6 12 22; 2 5 11 21 }
    { 7 17 32; 9 15 25; 7 13 23 }
    { 16 31; 19 29; 16 26 }
    { 30; 34; 30 }
    { 1 6 15 29; 2 5 11 21; 3 6 12 22 }
    { 5 14 28; 8 14 24; 8 14 24 }
    { 13 27; 18 28; 17 27 }
    { 26; 33; 31 }
    { 4 12 25; 7 13 23; 9 15 25 }
    { 11 24; 17 27; 18 28 }
    { 23; 32; 32 }
    { 10 22; 16 26; 19 29 }
    { 21; 31; 33 }
    { 20; 30; 34 }
}
straight! { straight_4 35
    { 0 3 9 19 34; 0 1 4 10 20; 0 1 4 10 20 }
    { 2 8 18 33; 3 6 12 22; 3 6 12 22 }
    { 7 17 32; 9 15 25; 9 15 25 }
    { 16 31; 19 29; 19 29 }
    { 30; 34; 34 }
    { 1 6 15 29; 2 5 11 21; 2 5 11 21 }
    { 5 14 28; 8 14 24; 8 14 24 }
    { 13 27; 18 28; 18 28 }
    { 26; 33; 33 }
    { 4 12 25; 7 13 23; 7 13 23 }
    { 11 24; 17 27; 17 27 }
    { 23; 32; 32 }
    { 10 22; 16 26; 16 26 }
    { 21; 31; 31 }
    { 20; 30; 30 }
}
straight! { straight_5_swapped 56
    { 0 3 9 19 34 55; 0 1 4 10 20 35; 0 1 4 10 20 35 }
    { 2 8 18 33 54; 3 6 12 22 37; 2 5 11 21 36 }
    { 7 17 32 53; 9 15 25 40; 7 13 23 38 }
    { 16 31 52; 19 29 44; 16 26 41 }
    { 30 51; 34 49; 30 45 }
    { 50; 55; 50 }
    { 1 6 15 29 49; 2 5 11 21 36; 3 6 12 22 37 }
    { 5 14 28 48; 8 14 24 39; 8 14 24 39 }
    { 13 27 47; 18 28 43; 17 27 42 }
    { 26 46; 33 48; 31 46 }
    { 45; 54; 51 }
    { 4 12 25 44; 7 13 23 38; 9 15 25 40 }
    { 11 24 43; 17 27 42; 18 28 43 }
    { 23 42; 32 47; 32 47 }
    { 41; 53; 52 }
    { 10 22 40; 16 26 41; 19 29 44 }
    { 21 39; 31 46; 33 48 }
    { 38; 52; 53 }
    { 20 37; 30 45; 34 49 }
    { 36; 51; 54 }
    { 35; 50; 55 }
}
straight! { straight_5 56
    { 0 3 9 19 34 55; 0 1 4 10 20 35; 0 1 4 10 20 35 }
    { 2 8 18 33 54; 3 6 12 22 37; 3 6 12 22 37 }
    { 7 17 32 53; 9 15 25 40; 9 15 25 40 }
    { 16 31 52; 19 29 44; 19 29 44 }
    { 30 51; 34 49; 34 49 }
    { 50; 55; 55 }
    { 1 6 15 29 49; 2 5 11 21 36; 2 5 11 21 36 }
    { 5 14 28 48; 8 14 24 39; 8 14 24 39 }
    { 13 27 47; 18 28 43; 18 28 43 }
    { 26 46; 33 48; 33 48 }
    { 45; 54; 54 }
    { 4 12 25 44; 7 13 23 38; 7 13 23 38 }
    { 11 24 43; 17 27 42; 17 27 42 }
    { 23 42; 32 47; 32 47 }
    { 41; 53; 53 }
    { 10 22 40; 16 26 41; 16 26 41 }
    { 21 39; 31 46; 31 46 }
    { 38; 52; 52 }
    { 20 37; 30 45; 30 45 }
    { 36; 51; 51 }
    { 35; 50; 50 }
}
straight! { straight_6_swapped 84
    { 0 3 9 19 34 55 83; 0 1 4 10 20 35 56; 0 1 4 10 20 35 56 }
    { 2 8 18 33 54 82; 3 6 12 22 37 58; 2 5 11 21 36 57 }
    { 7 17 32 53 81; 9 15 25 40 61; 7 13 23 38 59 }
    { 16 31 52 80; 19 29 44 65; 16 26 41 62 }
    { 30 51 79; 34 49 70; 30 45 66 }
    { 50 78; 55 76; 50 71 }
    { 77; 83; 77 }
    { 1 6 15 29 49 76; 2 5 11 21 36 57; 3 6 12 22 37 58 }
    { 5 14 28 48 75; 8 14 24 39 60; 8 14 24 39 60 }
    { 13 27 47 74; 18 28 43 64; 17 27 42 63 }
    { 26 46 73; 33 48 69; 31 46 67 }
    { 45 72; 54 75; 51 72 }
    { 71; 82; 78 }
    { 4 12 25 44 70; 7 13 23 38 59; 9 15 25 40 61 }
    { 11 24 43 69; 17 27 42 63; 18 28 43 64 }
    { 23 42 68; 32 47 68; 32 47 68 }
    { 41 67; 53 74; 52 73 }
    { 66; 81; 79 }
    { 10 22 40 65; 16 26 41 62; 19 29 44 65 }
    { 21 39 64; 31 46 67; 33 48 69 }
    { 38 63; 52 73; 53 74 }
    { 62; 80; 80 }
    { 20 37 61; 30 45 66; 34 49 70 }
    { 36 60; 51 72; 54 75 }
    { 59; 79; 81 }
    { 35 58; 50 71; 55 76 }
    { 57; 78; 82 }
    { 56; 77; 83 }
}
straight! { straight_6 84
    { 0 3 9 19 34 55 83; 0 1 4 10 20 35 56; 0 1 4 10 20 35 56 }
    { 2 8 18 33 54 82; 3 6 12 22 37 58; 3 6 12 22 37 58 }
    { 7 17 32 53 81; 9 15 25 40 61; 9 15 25 40 61 }
    { 16 31 52 80; 19 29 44 65; 19 29 44 65 }
    { 30 51 79; 34 49 70; 34 49 70 }
    { 50 78; 55 76; 55 76 }
    { 77; 83; 83 }
    { 1 6 15 29 49 76; 2 5 11 21 36 57; 2 5 11 21 36 57 }
    { 5 14 28 48 75; 8 14 24 39 60; 8 14 24 39 60 }
    { 13 27 47 74; 18 28 43 64; 18 28 43 64 }
    { 26 46 73; 33 48 69; 33 48 69 }
    { 45 72; 54 75; 54 75 }
    { 71; 82; 82 }
    { 4 12 25 44 70; 7 13 23 38 59; 7 13 23 38 59 }
    { 11 24 43 69; 17 27 42 63; 17 27 42 63 }
    { 23 42 68; 32 47 68; 32 47 68 }
    { 41 67; 53 74; 53 74 }
    { 66; 81; 81 }
    { 10 22 40 65; 16 26 41 62; 16 26 41 62 }
    { 21 39 64; 31 46 67; 31 46 67 }
    { 38 63; 52 73; 52 73 }
    { 62; 80; 80 }
    { 20 37 61; 30 45 66; 30 45 66 }
    { 36 60; 51 72; 51 72 }
    { 59; 79; 79 }
    { 35 58; 50 71; 50 71 }
    { 57; 78; 78 }
    { 56; 77; 77 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bernstein::{count, evaluate};
    use proptest::prelude::*;

    fn halved(degree: usize, kind: u8, c: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut near = vec![f64::NAN; c.len()];
        let mut far = near.clone();
        halve(degree, kind, c, &mut near, &mut far);
        (near, far)
    }

    proptest! {
        #[test]
        fn straight_line_code_equals_the_general_path(
            degree in 1usize..7, kind in 0u8..3,
            seed in proptest::collection::vec(-1.0..1.0f64, 84),
        ) {
            let c = &seed[..count(degree)];
            let (near, far) = halved(degree, kind, c);
            let mut general = (vec![0.0; c.len()], vec![0.0; c.len()]);
            halve_any_degree(degree, kind, c, &mut general.0, &mut general.1);
            prop_assert_eq!((near, far), general);
        }

        /// Evaluating a child equals evaluating the parent at the same point.
        #[test]
        fn children_have_the_parents_values(
            degree in 1usize..7, kind in 0u8..3,
            seed in proptest::collection::vec(-1.0..1.0f64, 84),
            b in proptest::array::uniform4(0.0..1.0f64),
        ) {
            let sum: f64 = b.iter().sum::<f64>().max(1e-9);
            let [p, q, r, s] = b.map(|x| x / sum);
            let c = &seed[..count(degree)];
            let (near, far) = halved(degree, kind, c);
            // Child vertices: near (v0,m,v1,v2); far (v3,m,v2,v1) or (v3,m,v1,v2).
            let in_parent_near = [p + 0.5 * q, r, s, 0.5 * q];
            let (v1, v2) = if kind == 0 { (s, r) } else { (r, s) };
            let in_parent_far = [0.5 * q, v1, v2, p + 0.5 * q];
            let close = |x: f64, y: f64| (x - y).abs() <= 1e-13;
            let here = [p, q, r, s];
            prop_assert!(close(evaluate(degree, &near, here), evaluate(degree, c, in_parent_near)));
            prop_assert!(close(evaluate(degree, &far, here), evaluate(degree, c, in_parent_far)));
        }

        /// Reversing the refinement edge exchanges the children's shared data bit for bit.
        #[test]
        fn shared_facet_bits_agree(degree in 1usize..7, seed in proptest::collection::vec(-1.0..1.0f64, 84)) {
            let c = &seed[..count(degree)];
            let mut reversed = c.to_vec();
            crate::bernstein::for_each_index(degree, |at, [i, j, k, _]| {
                reversed[index(j, k, i)] = c[at];
            });
            let (near, far) = halved(degree, 1, c);
            let (near_reversed, far_reversed) = halved(degree, 1, &reversed);
            prop_assert_eq!(&near, &far_reversed);
            prop_assert_eq!(&far, &near_reversed);
        }
    }
}
