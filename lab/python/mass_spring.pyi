"""Mass-spring cloth: nets, scenes, methods, advice.

SI units; z points up. n nodes, e springs, k states. docs/python.md has
examples, help(mass_spring.Net) the meaning of each argument.
"""
from os import PathLike
from typing import Final, NoReturn

from numpy.typing import ArrayLike, NDArray
from numpy import float64

__version__: Final[str]

class Method:
    def __init__(self, *nobody: NoReturn) -> None:
        self.name: Final[str]
        self.order: Final[int]
        self.forces: Final[int]
        self.limit: Final[float]
        self.good_for: Final[str]
        self.fails_when: Final[str]
        self.source: Final[str]

class Failure:
    def __init__(self, *nobody: NoReturn) -> None:
        self.kind: Final[str]
        self.step: Final[int]
        self.time: Final[float]
        self.dt: Final[float]
        self.node: Final[int | None]
        self.cause: Final[str]
        self.cure: Final[tuple[str, float] | None]

class Result:
    def __init__(self, *nobody: NoReturn) -> None:
        self.t: Final[NDArray[float64]]
        self.x: Final[NDArray[float64]]
        self.v: Final[NDArray[float64]]
        self.energy: Final[NDArray[float64]]
        self.work: Final[int]
        self.steps: Final[int]
        self.status: Final[int]
        self.why: Final[Failure | None]

class Rest:
    def __init__(self, *nobody: NoReturn) -> None:
        self.x: Final[NDArray[float64]]
        self.force: Final[NDArray[float64]]
        self.pins: Final[list[tuple[str, list[float]]]]
        self.residual: Final[float]
        self.load: Final[float]
        self.factors: Final[int]
        self.stable: Final[bool]
        self.growing: Final[list[int]]
        self.loose: Final[list[int]]
        self.slack: Final[list[list[int]]]
        self.frequencies: Final[list[float]]

class Advice:
    def __init__(self, *nobody: NoReturn) -> None:
        self.refusal: Final[str]
        self.method: Final[str]
        self.dt: Final[float]
        self.error: Final[float]
        self.tolerance: Final[float]
        self.work: Final[float]
        self.scene: Final[Scene]

class Scene:
    def __init__(self, *nobody: NoReturn) -> None:
        self.x: Final[NDArray[float64]]
    def limit(self, method: str) -> float: ...
    def run(self, method: str = "", t_end: float | None = None,
            dt: float | str | None = None, *, every: float | None = None,
            atol: float | None = None, x0: ArrayLike | None = None,
            v0: ArrayLike | None = None) -> Result: ...
    def rest(self) -> Rest: ...
    def force(self, x: ArrayLike, v: ArrayLike, t: float = 0.0
              ) -> NDArray[float64]: ...
    def advise(self, tolerance: float | None = None, method: str = ""
               ) -> Advice: ...

class Net(Scene):
    def __init__(self, x: ArrayLike, edges: ArrayLike, *,
                 k: ArrayLike = 100.0, L: ArrayLike | None = None,
                 mass: ArrayLike | None = None, fixed: ArrayLike = (),
                 v: ArrayLike | None = None, drag: float = 0.0,
                 gravity: ArrayLike = 9.81, cables: ArrayLike = (),
                 struts: ArrayLike = (), load: ArrayLike | None = None
                 ) -> None: ...

def scene(file: str | PathLike[str]) -> Scene: ...
def methods() -> list[Method]: ...
