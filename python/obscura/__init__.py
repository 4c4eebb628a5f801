"""Obscura renders glTF 2.0 assets: as the program obscura does, with the same bits.

    import obscura

    with obscura.Session() as session:
        shoe = session.open("shoe.glb")
        image = session.render(
            shoe,
            obscura.View(width=640, height=480),
            sampling=obscura.Sampling(samples_per_pixel=64, aov=["normal"]),
        )
        image["beauty"]  # (480, 640, 4) float32
        image["normal"]  # (480, 640, 3) float32
        session.write(image, "shoe.exr")

docs/python.md explains it.
"""

from collections.abc import Mapping as _Mapping

from ._cameras import from_colmap as _from_colmap
from ._cameras import from_opencv as _from_opencv
from ._changes import assign_material as _assign_material
from ._changes import hide as _hide
from ._changes import move as _move
from ._changes import set_material as _set_material
from ._changes import show as _show
from ._error import Error
from ._obscura import (
    AnimationInfo,
    Asset,
    AssetInfo,
    CameraInfo,
    Image,
    Layer,
    Look,
    Message,
    NodeInfo,
    OpenCvCamera,
    Sampling,
    Session,
    Statistics,
    Tile,
    View,
)
from ._obscura import version as __version__

__all__ = [
    "AnimationInfo",
    "Asset",
    "AssetInfo",
    "CameraInfo",
    "Error",
    "Image",
    "Layer",
    "Look",
    "Message",
    "NodeInfo",
    "OpenCvCamera",
    "Sampling",
    "Session",
    "Statistics",
    "Tile",
    "View",
]

Asset.move = _move
Asset.hide = _hide
Asset.show = _show
Asset.set_material = _set_material
Asset.assign_material = _assign_material
View.from_opencv = staticmethod(_from_opencv)
View.from_colmap = staticmethod(_from_colmap)
_Mapping.register(Image)
for _class in (Error, *(globals()[_name] for _name in __all__)):
    _class.__module__ = __name__
