"""CAD models from their exact surfaces, without tessellating them: arrays, pictures, OpenGL.

Lengths are the model's (millimetres for STEP and IGES), colors linear light from 0 to 1. Failures raise dupin.Error.
Long calls let other threads run; `progress(stage, fraction)` is called from any thread, and stops the work by returning False.
"""
from typing import Any, Callable, Optional, Sequence, Tuple, TypedDict, Union

import numpy as np
import numpy.typing as npt

__version__: str
Floats = npt.NDArray[np.float64]
Progress = Optional[Callable[[str, float], Optional[bool]]]
ColorLike = Optional[Sequence[float]]

class Error(RuntimeError):
    code: str  # invalid_argument unreadable limit no_device cannot_write cancelled

def load(path: str, *, time_limit: float = 0, memory_limit: int = 0, units: str = "mm", progress: Progress = None) -> Model: ...
def load_bytes(bytes: bytes, *, units: str = "mm") -> Model: ...
def set_threads(threads: int) -> None: ...
def compare(a: Union[str, npt.NDArray[Any]], b: Union[str, npt.NDArray[Any]], fov: float = 30) -> dict[str, Any]: ...

class Picture(TypedDict, total=False):
    screen: npt.NDArray[np.uint8]  # h x w x 4, sRGB, straight alpha
    color: npt.NDArray[np.float32]  # h x w x 4, linear, premultiplied
    normal: npt.NDArray[np.float32]
    depth: npt.NDArray[np.float32]  # along the view axis; +inf where nothing is drawn
    position: npt.NDArray[np.float32]
    curvature: npt.NDArray[np.float32]  # h x w x 2
    direction: npt.NDArray[np.float32]
    uv: npt.NDArray[np.float32]  # NaN where nothing that has any is drawn
    face: npt.NDArray[np.uint32]  # from 1 on; 0: nothing
    primitive: npt.NDArray[np.uint32]

class Model:
    source: str
    format: str
    unit: str
    box: Optional[Floats]  # 2 x 3
    instances: list[Tuple[str, str]]  # name of the placement, and of its part
    def info(self) -> dict[str, Any]: ...
    def sample(self, *, method: str = "uniform", grid: int = 0, spacing: float = 0, epsilon: float = 0.012, delta: float = 0,
               border: float = 0, tolerance: float = 0, progress: Progress = None) -> Points: ...
    def prepare(self, *, tolerance: float = 0, normal_tolerance: float = 0.25, progress: Progress = None) -> Prepared: ...
    def render(self, *, size: Tuple[int, int] = (1024, 1024), view: str = "iso", eye: Sequence[float] = ..., target: Sequence[float] = ...,
               up: Sequence[float] = ..., fov: float = 30, orthographic: bool = False, height: float = 0,
               outputs: Sequence[str] = ("screen",), shading: str = "lit", edges: bool = True, edge_width: float = 1.2,
               samples: int = 4, color: ColorLike = None, background: ColorLike = (1, 1, 1, 1), lights: Sequence[Sequence[float]] = (),
               sections: Sequence[Sequence[float]] = (), curvature_scale: float = 0, tolerance_px: float = 0.5,
               normal_tolerance: float = 0.25, progress: Progress = None) -> Picture: ...

class Points:
    """Views of one memory; every placement's points, one after the other."""
    positions: Floats
    normals: Floats
    directions: Floats
    curvatures: Floats
    half_extents: Floats
    uv: Floats
    bounds: Floats
    faces: npt.NDArray[np.uint32]
    instances: npt.NDArray[np.uint32]
    notes: list[str]
    skipped: list[Tuple[str, str]]
    def __len__(self) -> int: ...

class Prepared:
    model: Model
    tolerance: float
    primitives: int

class Job:
    done: bool
    fraction: float
    stage: str
    def __init__(self, path: str, *, tolerance: float = 0, units: str = "mm") -> None: ...
    def cancel(self) -> None: ...
    def result(self) -> Prepared: ...

class Scene:
    """Models in the OpenGL context (3.3 and up) that is current where it is made, used and let go."""
    box: Optional[Floats]
    objects: list[int]
    gl_renderer: str
    refining: bool
    def __init__(self, get_proc_address: Optional[Callable[[str], int]] = None) -> None: ...
    def add(self, prepared: Prepared, matrix: Optional[npt.ArrayLike] = None) -> int: ...
    def replace(self, object: int, prepared: Prepared) -> None: ...
    def remove(self, object: int) -> None: ...
    def place(self, object: int, matrix: Optional[npt.ArrayLike]) -> None: ...
    def set_visible(self, object: int, visible: bool, instance: int = ..., face: int = ...) -> None: ...
    def set_color(self, object: int, color: ColorLike, instance: int = ..., face: int = ...) -> None: ...
    def set_highlight(self, object: int, color: ColorLike, instance: int = ..., face: int = ...) -> None: ...
    def draw(self, view: npt.ArrayLike, projection: npt.ArrayLike, viewport: Sequence[int], *, shading: str = "lit", edges: bool = True,
             edge_width: float = 1.2, samples: int = 1, color: ColorLike = None, lights: Sequence[Sequence[float]] = (),
             sections: Sequence[Sequence[float]] = (), curvature_scale: float = 0) -> dict[str, Any]: ...
    def pick(self, view: npt.ArrayLike, projection: npt.ArrayLike, viewport: Sequence[int], x: int, y: int) -> Optional[dict[str, Any]]: ...
    def refine(self, view: npt.ArrayLike, projection: npt.ArrayLike, viewport: Sequence[int], tolerance_px: float = 0.5) -> None: ...
