"""A glTF file with a material that has pictures, for tests of `sssgen use`."""

from __future__ import annotations

from typing import Any

from gltf_files import box, data_uri, png


def textured(**more: Any) -> tuple[dict[str, Any], bytes]:
    """A cube of 2 m with pictures: a colour, a relief, an occlusion and a roughness."""
    content, data = box({
        "name": "Skin",
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 2}, "metallicFactor": 0.0,
        },
        "normalTexture": {"index": 1},
        "occlusionTexture": {"index": 2},
        "emissiveFactor": [0.5, 0.0, 0.0],
    })  # fmt: skip
    pictures = [png((200, 100, 50)), png((128, 128, 255)), png((255, 102, 0))]
    content["images"] = [{"uri": data_uri(picture), "name": f"picture{i}"} for i, picture in enumerate(pictures)]
    content["textures"] = [{"source": index} for index in range(3)]
    content["nodes"] = [{"mesh": 0, "scale": [2.0, 2.0, 2.0], "translation": [1.0, 0.0, 0.0]}]
    return content | more, data
