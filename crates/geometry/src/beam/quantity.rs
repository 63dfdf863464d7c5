//! What a beam can bend: numbers, and vectors of numbers.

use std::ops::{Add, Mul, Sub};

use glam::{DVec2, DVec3};

/// A value the linear beam equation can be solved for, component by component.
pub trait Quantity:
    Copy + Default + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
    /// Largest component without its sign.
    fn largest(self) -> f64;
    /// Whether every component is a finite number.
    fn finite(self) -> bool;
}

impl Quantity for f64 {
    fn largest(self) -> f64 {
        self.abs()
    }

    fn finite(self) -> bool {
        self.is_finite()
    }
}

impl Quantity for DVec2 {
    fn largest(self) -> f64 {
        self.abs().max_element()
    }

    fn finite(self) -> bool {
        self.is_finite()
    }
}

impl Quantity for DVec3 {
    fn largest(self) -> f64 {
        self.abs().max_element()
    }

    fn finite(self) -> bool {
        self.is_finite()
    }
}
