"""Types of the package; docs/python.md explains it."""

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any, Literal, Protocol, Union

import numpy as np
import numpy.typing as npt

__version__: str

_File = Union[str, bytes, "os.PathLike[str]", "os.PathLike[bytes]"]
_Numbers = npt.ArrayLike
_Pixels = npt.NDArray[np.float32]

class _Event(Protocol):
    def is_set(self) -> bool: ...

class Error(Exception):
    id: str
    place: str
    text: str
    code: int
    also: tuple[Error, ...]
    def __init__(
        self, id: str, place: str, text: str, code: int = 70, also: Sequence[Error] = ()
    ) -> None: ...

class OpenCvCamera:
    K: _Numbers
    R: _Numbers
    t: _Numbers
    width: int
    height: int
    pixel_center: float
    def __init__(
        self,
        *,
        K: _Numbers = ...,
        R: _Numbers = ...,
        t: _Numbers = ...,
        width: int = 0,
        height: int = 0,
        pixel_center: float = 0.5,
    ) -> None: ...
    def replace(self, **keywords: Any) -> OpenCvCamera: ...

_CameraModel = Literal["pinhole", "orthographic", "thin_lens", "fisheye", "environment"]
_Fisheye = Literal["equidistant", "equisolid", "stereographic", "orthographic", "opencv"]

class View:
    width: int
    height: int
    crop: _Numbers | None
    camera: str | int | None
    eye: _Numbers | None
    target: _Numbers | None
    up: _Numbers | None
    world_from_camera: _Numbers | None
    camera_json: _File | None
    opencv: OpenCvCamera | None
    camera_model: _CameraModel | None
    fov_deg: float | None
    near_m: float | None
    far_m: float | None
    magnification_m: _Numbers | None
    focal_length_m: float | None
    sensor_m: _Numbers | None
    shift: _Numbers | None
    distortion: _Numbers | None
    fstop: float | None
    lens_radius_m: float | None
    focus_distance_m: float | None
    focus_on_px: _Numbers | None
    blades: int | None
    blade_rotation_deg: float | None
    anamorphic: float | None
    aperture: _File | None
    fisheye: _Fisheye | None
    fisheye_fit: Literal["circle", "diagonal"] | None
    fisheye_coefficients: _Numbers | None
    projection: Literal["latlong", "cylindrical", "cubemap"] | None
    align: Literal["world", "view"] | None
    stereo_m: float | None
    ev100: float | None
    exposure_s: float | None
    iso: float | None
    time_s: float | None
    shutter_s: _Numbers | None
    def __init__(
        self,
        *,
        width: int = 1280,
        height: int = 720,
        crop: _Numbers | None = None,
        camera: str | int | None = None,
        eye: _Numbers | None = None,
        target: _Numbers | None = None,
        up: _Numbers | None = None,
        world_from_camera: _Numbers | None = None,
        camera_json: _File | None = None,
        opencv: OpenCvCamera | None = None,
        camera_model: _CameraModel | None = None,
        fov_deg: float | None = None,
        near_m: float | None = None,
        far_m: float | None = None,
        magnification_m: _Numbers | None = None,
        focal_length_m: float | None = None,
        sensor_m: _Numbers | None = None,
        shift: _Numbers | None = None,
        distortion: _Numbers | None = None,
        fstop: float | None = None,
        lens_radius_m: float | None = None,
        focus_distance_m: float | None = None,
        focus_on_px: _Numbers | None = None,
        blades: int | None = None,
        blade_rotation_deg: float | None = None,
        anamorphic: float | None = None,
        aperture: _File | None = None,
        fisheye: _Fisheye | None = None,
        fisheye_fit: Literal["circle", "diagonal"] | None = None,
        fisheye_coefficients: _Numbers | None = None,
        projection: Literal["latlong", "cylindrical", "cubemap"] | None = None,
        align: Literal["world", "view"] | None = None,
        stereo_m: float | None = None,
        ev100: float | None = None,
        exposure_s: float | None = None,
        iso: float | None = None,
        time_s: float | None = None,
        shutter_s: _Numbers | None = None,
    ) -> None: ...
    def replace(self, **keywords: Any) -> View: ...
    @staticmethod
    def from_opencv(
        K: _Numbers,
        R: _Numbers,
        t: _Numbers,
        width: int,
        height: int,
        distortion: _Numbers | None = None,
        *,
        fisheye: bool = False,
        pixel_center: float = 0.5,
        **more: Any,
    ) -> View: ...
    @staticmethod
    def from_colmap(
        model: str,
        width: int,
        height: int,
        params: Sequence[float],
        qvec: Sequence[float],
        tvec: _Numbers,
        **more: Any,
    ) -> View: ...

_Background = Literal["environment", "transparent", "color"]

class Look:
    environment: _File | None
    environment_intensity: float
    environment_rotation_deg: float
    background: _Background
    background_color: _Numbers
    point_size_px: float
    line_width_px: float
    def __init__(
        self,
        *,
        environment: _File | None = None,
        environment_intensity: float = 1,
        environment_rotation_deg: float = 0,
        background: _Background = "environment",
        background_color: _Numbers = (0, 0, 0),
        point_size_px: float = 3,
        line_width_px: float = 2,
    ) -> None: ...
    def replace(self, **keywords: Any) -> Look: ...

_Integrator = Literal[
    "path",
    "direct",
    "raycast",
    "ao",
    "normal",
    "facing",
    "depth",
    "distance",
    "uv",
    "albedo",
    "id",
    "wireframe",
    "heat",
]
_Filter = Literal["box", "gaussian", "blackman_harris"]

class Sampling:
    integrator: _Integrator
    samples_per_pixel: int
    noise_target: float | None
    spp_min: int | None
    max_bounces: int
    seed: int
    filter: _Filter
    ao_distance_m: float | None
    wire_width_px: float
    clamp_direct: float
    clamp_indirect: float
    caustics: bool
    regularize: bool
    aov: Sequence[str]
    crypto_levels: int
    def __init__(
        self,
        *,
        integrator: _Integrator = "path",
        samples_per_pixel: int = 64,
        noise_target: float | None = None,
        spp_min: int | None = None,
        max_bounces: int = 8,
        seed: int = 0,
        filter: _Filter = "box",
        ao_distance_m: float | None = None,
        wire_width_px: float = 1,
        clamp_direct: float = 0,
        clamp_indirect: float = 0,
        caustics: bool = True,
        regularize: bool = False,
        aov: Sequence[str] = (),
        crypto_levels: int = 6,
    ) -> None: ...
    def replace(self, **keywords: Any) -> Sampling: ...

class CameraInfo:
    @property
    def name(self) -> str: ...
    @property
    def orthographic(self) -> bool: ...
    @property
    def world_from_camera(self) -> npt.NDArray[np.float64]: ...
    @property
    def fov_deg(self) -> float: ...

class AnimationInfo:
    @property
    def name(self) -> str: ...
    @property
    def end_s(self) -> float: ...

class NodeInfo:
    @property
    def path(self) -> str: ...
    @property
    def mesh(self) -> str | None: ...

_Point = tuple[float, float, float]

class _Facts:
    @property
    def file(self) -> str: ...
    @property
    def generator(self) -> str: ...
    @property
    def copyright(self) -> str: ...
    @property
    def scenes(self) -> tuple[str, ...]: ...
    @property
    def scene(self) -> int: ...
    @property
    def variants(self) -> tuple[str, ...]: ...
    @property
    def cameras(self) -> tuple[CameraInfo, ...]: ...
    @property
    def animations(self) -> tuple[AnimationInfo, ...]: ...
    @property
    def materials(self) -> tuple[str, ...]: ...
    @property
    def bounds(self) -> tuple[_Point, _Point] | None: ...
    @property
    def triangles(self) -> int: ...

class AssetInfo(_Facts): ...

class Asset(_Facts):
    @property
    def nodes(self) -> tuple[NodeInfo, ...]: ...
    @property
    def info(self) -> AssetInfo: ...
    @property
    def closed(self) -> bool: ...
    def close(self) -> None: ...
    def set(self, pointer: str, value: _Numbers) -> None: ...
    def set_variant(self, name: str | None) -> None: ...
    def reset(self) -> None: ...
    def move(
        self,
        node: str | int,
        *,
        matrix: _Numbers | None = None,
        translation: _Numbers | None = None,
        rotation: _Numbers | None = None,
        scale: _Numbers | None = None,
    ) -> None: ...
    def hide(self, node: str | int) -> None: ...
    def show(self, node: str | int) -> None: ...
    def set_material(
        self,
        material: str | int,
        *,
        base_color: _Numbers = ...,
        metallic: float = ...,
        roughness: float = ...,
        emissive: _Numbers = ...,
        alpha_cutoff: float = ...,
    ) -> None: ...
    def assign_material(self, node: str | int, material: str | int) -> None: ...

class Message:
    @property
    def is_warning(self) -> bool: ...
    @property
    def place(self) -> str: ...
    @property
    def text(self) -> str: ...

class Tile:
    @property
    def x(self) -> int: ...
    @property
    def y(self) -> int: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def channels(self) -> tuple[str, ...]: ...
    @property
    def pixels(self) -> _Pixels: ...

class Layer:
    @property
    def name(self) -> str: ...
    @property
    def channels(self) -> tuple[str, ...]: ...
    @property
    def kind(self) -> Literal["color", "data", "id"]: ...
    @property
    def reduction(self) -> str: ...
    @property
    def expression(self) -> str: ...
    @property
    def pixels(self) -> _Pixels: ...
    @property
    def ids(self) -> dict[str, float]: ...
    @property
    def attributes(self) -> dict[str, str]: ...

class Statistics:
    @property
    def render_seconds(self) -> float: ...
    @property
    def paths(self) -> int: ...
    @property
    def rays(self) -> int: ...
    @property
    def nonfinite_samples(self) -> int: ...

class Image(Mapping[str, _Pixels]):
    def __getitem__(self, name: str) -> _Pixels: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def part(self) -> tuple[int, int, int, int]: ...
    def channels(self, name: str = "beauty") -> tuple[str, ...]: ...
    def layer(self, name: str) -> Layer: ...
    @property
    def attributes(self) -> dict[str, str]: ...
    @property
    def statistics(self) -> Statistics: ...

class Session:
    def __init__(self, *, log: Callable[[Message], object] | None = None) -> None: ...
    def open(
        self,
        path: _File,
        *,
        scene: str | int | None = None,
        variant: str | None = None,
        animation: str | None = None,
        threads: int = 0,
        lenient: bool = False,
        ambient_occlusion: bool = False,
        fps: float | None = None,
    ) -> Asset: ...
    def render(
        self,
        asset: Asset,
        view: View | None = None,
        look: Look | None = None,
        sampling: Sampling | None = None,
        *,
        threads: int = 0,
        isa: Literal["auto", "baseline", "avx2", "avx512"] = "auto",
        tile_size: int = 16,
        cancel: _Event | None = None,
        progress: Callable[[float], object] | None = None,
        tile: Callable[[Tile], object] | None = None,
    ) -> Image: ...
    def write(
        self,
        image: Image,
        path: _File,
        *,
        float32: bool = False,
        exr_layout: Literal["single", "multipart", "separate"] = "single",
        exposure_ev: float = 0,
        ocio_config: _File | None = None,
        display: str | None = None,
        view: str | None = None,
        bits: Literal[8, 16] = 8,
        quality: int | None = None,
        dither: bool = True,
        page: _Numbers | None = None,
    ) -> None: ...
    def close(self) -> None: ...
    @property
    def closed(self) -> bool: ...
    def __enter__(self) -> Session: ...
    def __exit__(
        self,
        type: type[BaseException] | None,
        value: BaseException | None,
        traceback: TracebackType | None,
    ) -> None: ...
