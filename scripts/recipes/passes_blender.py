"""Puts the passes of `lightwell ar run --passes` together again, in Blender's compositor.

    blender --background --python passes_blender.py -- PASSES/000000.exr OUT_ 30     (first file, name of pictures, frames)

composite = objects over background, plus added, plus noise; all linear. The frames are written as OpenEXR.
"""

import sys

import bpy


def build(first_file, out, frames):
    scene = bpy.context.scene
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    image = bpy.data.images.load(first_file)
    image.source = "SEQUENCE"
    image.colorspace_settings.name = "Linear Rec.709" if bpy.app.version >= (4, 0, 0) else "Linear"
    passes = tree.nodes.new("CompositorNodeImage")
    passes.image = image
    passes.frame_duration = frames
    passes.frame_start = 1
    passes.frame_offset = int("".join(c for c in first_file.rsplit(".", 1)[0][-6:] if c.isdigit())) - 1

    over = tree.nodes.new("CompositorNodeAlphaOver")  # objects are premultiplied
    over.use_premultiply = False
    over.premul = 0
    tree.links.new(passes.outputs["background"], over.inputs[1])
    tree.links.new(passes.outputs["objects"], over.inputs[2])
    last = over.outputs[0]
    for name in ("added", "noise"):
        plus = tree.nodes.new("CompositorNodeMixRGB")
        plus.blend_type = "ADD"
        plus.use_clamp = False
        plus.inputs[0].default_value = 1
        tree.links.new(last, plus.inputs[1])
        tree.links.new(passes.outputs[name], plus.inputs[2])
        last = plus.outputs[0]
    composite = tree.nodes.new("CompositorNodeComposite")
    tree.links.new(last, composite.inputs[0])

    scene.frame_start, scene.frame_end = 1, frames
    scene.render.resolution_x, scene.render.resolution_y = image.size
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = out
    scene.view_settings.view_transform = "Standard"


if __name__ == "__main__":
    first, name, count = sys.argv[sys.argv.index("--") + 1 :]
    build(first, name, int(count))
    bpy.ops.render.render(animation=True)
