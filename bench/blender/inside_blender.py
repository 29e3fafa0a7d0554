"""What the scripts that run inside Blender share."""
import os
import sys
import traceback

import bpy


def leave_after(main):
    """Runs main(the first argument after "--") and ends the process with its success; Blender itself would leave with 0 after an exception of a script."""
    try:
        main(sys.argv[sys.argv.index("--") + 1])
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    sys.stdout.flush()
    os._exit(0)


class Nodes:
    """Arithmetic in a node tree: operands are sockets or numbers."""

    def __init__(self, tree):
        self.tree = tree

    def new(self, kind, output=0, **inputs):
        node = self.tree.nodes.new(kind)
        for name, value in inputs.items():
            self.feed(node.inputs[name.replace("_", " ")], value)
        return node.outputs[output]

    def feed(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        else:
            socket.default_value = value

    def math(self, operation, a, b):
        node = self.tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        self.feed(node.inputs[0], a)
        self.feed(node.inputs[1], b)
        return node.outputs[0]

    def vector_math(self, operation, a, b, output=0):
        node = self.tree.nodes.new("ShaderNodeVectorMath")
        node.operation = operation
        self.feed(node.inputs[0], a)
        self.feed(node.inputs[1], b)
        return node.outputs[output]

    def product(self, a, b):
        return self.vector_math("MULTIPLY", a, b)

    def reflected_once(self, depth=1.5):
        """1 for light that has been reflected before it came here, 0 for light that comes straight."""
        return self.math("GREATER_THAN", self.new("ShaderNodeLightPath", "Ray Depth"), depth)
