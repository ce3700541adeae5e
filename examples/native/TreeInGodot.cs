// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Godot 4 with .NET: x east, y up, -z north, right-handed. One MultiMesh of cylinders.
using Godot;

public partial class TreeInGodot : MultiMeshInstance3D
{
    [Export(PropertyHint.File)] public string File = "res://oak.sway";
    [Export] public Vector3 Wind = new Vector3(5, 0, 0);  // where the air goes, in the world [m/s]
    SwayTree tree;

    public static Vector3 Point(double x, double y, double z) =>
        new Vector3((float)x, (float)z, (float)-y);

    public static Quaternion Rotation(double x, double y, double z, double w) =>
        new Quaternion((float)x, (float)z, (float)-y, (float)w);

    public override void _Ready()
    {
        tree = new SwayTree(FileAccess.GetFileAsBytes(File));
        Multimesh = new MultiMesh
        {
            TransformFormat = MultiMesh.TransformFormatEnum.Transform3D,
            Mesh = new CylinderMesh { TopRadius = 0.5f, BottomRadius = 0.5f, Height = 1 },
            InstanceCount = tree.Lengths.Length,
        };
    }

    public override void _Process(double delta)
    {
        if (tree == null) return;
        var air = GlobalTransform.Basis.Inverse() * Wind;
        tree.Step(air.X, -air.Z, air.Y, delta);
        var p = tree.Poses;
        for (int i = 0, k = 0; i < tree.Lengths.Length; i++, k += 7)
        {
            var turn = new Basis(Rotation(p[k + 3], p[k + 4], p[k + 5], p[k + 6]));
            var along = turn.X * (float)tree.Lengths[i];
            var thick = (float)tree.Diameters[i];
            // A cylinder stands on y, a segment lies on x.
            var basis = new Basis(-turn.Y * thick, along, turn.Z * thick);
            var middle = Point(p[k], p[k + 1], p[k + 2]) + along * 0.5f;
            Multimesh.SetInstanceTransform(i, new Transform3D(basis, middle));
        }
    }

    public override void _ExitTree() => tree?.Dispose();
}
