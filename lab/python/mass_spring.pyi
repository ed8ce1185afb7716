"""Mass-spring cloth: nets, scenes, methods, advice.

SI units; z points up. n nodes, e springs, k states. docs/python.md has
examples, help(mass_spring.Net) the meaning of each argument.
"""
from numpy.typing import ArrayLike, NDArray
from numpy import float64

class Method:
    name: str
    order: int
    forces: int
    limit: float
    good_for: str
    fails_when: str
    source: str

class Failure:
    kind: str
    step: int
    time: float
    dt: float
    node: int | None
    cause: str
    cure: tuple[str, float] | None

class Result:
    t: NDArray[float64]
    x: NDArray[float64]
    v: NDArray[float64]
    energy: NDArray[float64]
    work: int
    steps: int
    status: int
    why: Failure | None

class Rest:
    x: NDArray[float64]
    force: NDArray[float64]
    pins: list[tuple[str, list[float]]]
    residual: float
    load: float
    factors: int
    stable: bool
    growing: list[int]
    loose: list[int]
    frequencies: list[float]

class Advice:
    refusal: str
    method: str
    dt: float
    error: float
    tolerance: float
    work: float
    scene: Scene

class Scene:
    @property
    def x(self) -> NDArray[float64]: ...
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
                 gravity: float = 9.81) -> None: ...

def scene(file: str) -> Scene: ...
def methods() -> list[Method]: ...
