use super::*;
use crate::samples::{cube, sphere, together};
use crate::{Properties, Shells};
