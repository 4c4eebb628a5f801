"""Views from the cameras of computer vision; docs/cameras.md has the formulas."""

from ._numbers import numbers_of
from ._obscura import OpenCvCamera, View


def from_opencv(
    K, R, t, width, height, distortion=None, *, fisheye=False, pixel_center=0.5, **more
):
    """A View through OpenCV's camera: X_camera = R X_world + t, +X right, +Y down, +Z ahead.

    K: 3x3, fx 0 cx, 0 fy cy, 0 0 1, in pixels of a width x height image.
    R: 3x3, a rotation. t: 3 numbers, metres. The world is glTF's: +Y up.
    distortion: k1 k2 p1 p2 [k3]; with fisheye=True k1 k2 k3 k4. None: none.
    pixel_center: where K has the first pixel's centre: 0.5, or 0 for a K of OpenCV's calibration.
    more: further settings of View. Its own width and height may differ, which scales the image.
    """
    camera = OpenCvCamera(K=K, R=R, t=t, width=width, height=height, pixel_center=pixel_center)
    settings = {"width": width, "height": height, "opencv": camera}
    if fisheye:
        settings["fisheye"] = "opencv"
        settings["fisheye_coefficients"] = [0] * 4 if distortion is None else distortion
    elif distortion is not None:
        settings["distortion"] = _five(distortion)
    settings.update(more)
    return View(**settings)


def _five(distortion):
    """Four coefficients leave out k3."""
    numbers = numbers_of("distortion", getattr(distortion, "ravel", lambda: distortion)(), (4, 5))
    return [*numbers, 0] if len(numbers) == 4 else numbers


# Of each model: where its parameters have fx, fy, cx, cy, and which are coefficients, in the order
# of OpenCV; None is a zero.
_MODELS = {
    "SIMPLE_PINHOLE": (3, (0, 0, 1, 2), ()),
    "PINHOLE": (4, (0, 1, 2, 3), ()),
    "SIMPLE_RADIAL": (4, (0, 0, 1, 2), (3, None, None, None, None)),
    "RADIAL": (5, (0, 0, 1, 2), (3, 4, None, None, None)),
    "OPENCV": (8, (0, 1, 2, 3), (4, 5, 6, 7, None)),
    "SIMPLE_RADIAL_FISHEYE": (4, (0, 0, 1, 2), (3, None, None, None)),
    "RADIAL_FISHEYE": (5, (0, 0, 1, 2), (3, 4, None, None)),
    "OPENCV_FISHEYE": (8, (0, 1, 2, 3), (4, 5, 6, 7)),
}


def from_colmap(model, width, height, params, qvec, tvec, **more):
    """A View through COLMAP's camera, with the numbers of its cameras.txt and images.txt.

    model: one of SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, SIMPLE_RADIAL_FISHEYE,
        RADIAL_FISHEYE, OPENCV_FISHEYE; params: its parameters, in COLMAP's order.
    qvec: (qw, qx, qy, qz), camera from world. tvec: (x, y, z), metres.
    more: as of from_opencv.
    """
    if not isinstance(model, str):
        raise TypeError(f"model: expected a name, not {type(model).__name__}")
    if model not in _MODELS:
        raise ValueError(f"model: '{model}' is no choice; expected one of: {', '.join(_MODELS)}")
    count, intrinsics, coefficients = _MODELS[model]
    params = numbers_of(f"params of {model}", _as_numbers(params), (count,)).tolist()
    fx, fy, cx, cy = (params[i] for i in intrinsics)
    distortion = [0.0 if i is None else params[i] for i in coefficients]
    return from_opencv(
        [[fx, 0, cx], [0, fy, cy], [0, 0, 1]],
        _rotation(qvec),
        tvec,
        width,
        height,
        distortion or None,
        fisheye=model.endswith("FISHEYE"),
        **more,
    )


def _as_numbers(texts):
    """The words of a line of cameras.txt or images.txt, split, are as good as numbers."""
    try:
        return [float(one) if isinstance(one, str) else one for one in texts]
    except (TypeError, ValueError):
        return texts


def _rotation(qvec):
    """The matrix of a quaternion of any length but zero."""
    w, x, y, z = numbers_of("qvec", _as_numbers(qvec), (4,)).tolist()
    square = w * w + x * x + y * y + z * z
    if not square > 0:
        raise ValueError("qvec: it is no rotation, for its length is zero")
    s = 2 / square
    return [
        [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
    ]
