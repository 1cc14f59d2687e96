//! Which Riemann solvers and gases a program links.

use crate::flow::error::Error;
use crate::flow::kernel::sweep::Sweep;
use crate::flow::problem::Problem;
use crate::flow::riemann::{Hllc, HllcLowMach, Hlle, Riemann, Rusanov, Solver};
use crate::number::real::Real;
use core::marker::PhantomData;

/// The solvers and gases that [`Problem::step_by`] is compiled for: [`AnyFlux`] or one [`OneFlux`].
///
/// The sweep over the cells is compiled for each kind of gas and calls a solver by pointers. A program that names one of them links no other, but with HLLC the
/// fluxes of HLLE in two and three dimensions, which faces along strong shocks have.
pub trait FluxChoice: Choice {}

/// All solvers and gases but mixed ones; the problem says which.
#[derive(Clone, Copy, Debug)]
pub struct AnyFlux;

/// All solvers and gases, mixed ones too.
#[derive(Clone, Copy, Debug)]
pub struct AnyGas;

/// One solver (of [`crate::flow::riemann`]: [`Hllc`], [`HllcLowMach`], [`Hlle`], [`Rusanov`]) and one kind of gas ([`WithEnergy`], [`Barotropic`],
/// [`MixedGas`]).
/// A problem that asks for another is refused.
#[derive(Clone, Copy, Debug)]
pub struct OneFlux<S, G>(PhantomData<(S, G)>);

/// A gas with an energy equation: [`crate::flow::Gas::Ideal`].
#[derive(Clone, Copy, Debug)]
pub struct WithEnergy;

/// A gas without: [`crate::flow::Gas::Isothermal`] and [`crate::flow::Gas::Isentropic`].
#[derive(Clone, Copy, Debug)]
pub struct Barotropic;

/// A gas of several ratios of specific heats: [`crate::flow::Gas::Mixed`].
#[derive(Clone, Copy, Debug)]
pub struct MixedGas;

mod sealed {
    use super::{Error, Problem, Real, Sweep};

    /// How a choice is made; nobody else can make one.
    pub trait Choice {
        /// The sweep that a problem asks for.
        fn sweep<R: Real, const D: usize>(problem: &Problem<'_, R, D>) -> Result<Sweep<R, D>, Error>;
    }
}
pub(in crate::flow) use sealed::Choice;

impl FluxChoice for AnyFlux {}

impl Choice for AnyFlux {
    fn sweep<R: Real, const D: usize>(problem: &Problem<'_, R, D>) -> Result<Sweep<R, D>, Error> {
        if problem.gas.is_mixed() {
            return Err(Error::OtherFlux);
        }
        Ok(match (problem.gas.has_energy(), problem.scheme.riemann) {
            (true, Riemann::Hllc) => Sweep::by::<Hllc, true, false>(),
            (true, Riemann::HllcLowMach) => Sweep::by::<HllcLowMach, true, false>(),
            (true, Riemann::Hlle) => Sweep::by::<Hlle, true, false>(),
            (true, Riemann::Rusanov) => Sweep::by::<Rusanov, true, false>(),
            (false, Riemann::Hllc) => Sweep::by::<Hllc, false, false>(),
            (false, Riemann::HllcLowMach) => Sweep::by::<HllcLowMach, false, false>(),
            (false, Riemann::Hlle) => Sweep::by::<Hlle, false, false>(),
            (false, Riemann::Rusanov) => Sweep::by::<Rusanov, false, false>(),
        })
    }
}

impl FluxChoice for AnyGas {}

impl Choice for AnyGas {
    fn sweep<R: Real, const D: usize>(problem: &Problem<'_, R, D>) -> Result<Sweep<R, D>, Error> {
        if !problem.gas.is_mixed() {
            return AnyFlux::sweep(problem);
        }
        Ok(match problem.scheme.riemann {
            Riemann::Hllc => Sweep::by::<Hllc, true, true>(),
            Riemann::HllcLowMach => Sweep::by::<HllcLowMach, true, true>(),
            Riemann::Hlle => Sweep::by::<Hlle, true, true>(),
            Riemann::Rusanov => Sweep::by::<Rusanov, true, true>(),
        })
    }
}

impl<S: Solver> FluxChoice for OneFlux<S, WithEnergy> {}

impl<S: Solver> Choice for OneFlux<S, WithEnergy> {
    fn sweep<R: Real, const D: usize>(problem: &Problem<'_, R, D>) -> Result<Sweep<R, D>, Error> {
        asked::<R, D, S, true, false>(problem)
    }
}

impl<S: Solver> FluxChoice for OneFlux<S, Barotropic> {}

impl<S: Solver> Choice for OneFlux<S, Barotropic> {
    fn sweep<R: Real, const D: usize>(problem: &Problem<'_, R, D>) -> Result<Sweep<R, D>, Error> {
        asked::<R, D, S, false, false>(problem)
    }
}

impl<S: Solver> FluxChoice for OneFlux<S, MixedGas> {}

impl<S: Solver> Choice for OneFlux<S, MixedGas> {
    fn sweep<R: Real, const D: usize>(problem: &Problem<'_, R, D>) -> Result<Sweep<R, D>, Error> {
        asked::<R, D, S, true, true>(problem)
    }
}

/// The one sweep there is; refuses a problem that asks for another solver or another kind of gas.
fn asked<R: Real, const D: usize, S: Solver, const ENERGY: bool, const MIXED: bool>(
    problem: &Problem<'_, R, D>,
) -> Result<Sweep<R, D>, Error> {
    let same =
        problem.scheme.riemann == S::KIND && problem.gas.has_energy() == ENERGY && problem.gas.is_mixed() == MIXED;
    if same { Ok(Sweep::by::<S, ENERGY, MIXED>()) } else { Err(Error::OtherFlux) }
}
