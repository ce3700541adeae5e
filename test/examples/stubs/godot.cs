// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// What the example takes from GodotSharp, and a program that runs it. No engine is here.
using System;
using System.Globalization;
using Godot;

namespace Godot
{
    public enum PropertyHint { None, File }
    public class ExportAttribute : Attribute { public ExportAttribute(PropertyHint hint = 0) { } }
    public static class FileAccess
    {
        public static byte[] GetFileAsBytes(string path) => System.IO.File.ReadAllBytes(path);
    }

    public struct Vector3
    {
        public float X, Y, Z;
        public Vector3(float x, float y, float z) { X = x; Y = y; Z = z; }
        public static Vector3 operator +(Vector3 a, Vector3 b) =>
            new Vector3(a.X + b.X, a.Y + b.Y, a.Z + b.Z);
        public static Vector3 operator -(Vector3 a) => new Vector3(-a.X, -a.Y, -a.Z);
        public static Vector3 operator *(Vector3 a, float s) =>
            new Vector3(a.X * s, a.Y * s, a.Z * s);
    }

    public struct Quaternion
    {
        public float X, Y, Z, W;
        public Quaternion(float x, float y, float z, float w) { X = x; Y = y; Z = z; W = w; }
    }

    public struct Basis
    {
        public Vector3 X, Y, Z;  // columns
        public Basis(Vector3 x, Vector3 y, Vector3 z) { X = x; Y = y; Z = z; }
        public Basis(Quaternion q)
        {
            float x = q.X, y = q.Y, z = q.Z, w = q.W;
            float s = 2 / (x * x + y * y + z * z + w * w);
            X = new Vector3(1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y));
            Y = new Vector3(s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x));
            Z = new Vector3(s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y));
        }
        public static Vector3 operator *(Basis b, Vector3 v) => b.X * v.X + b.Y * v.Y + b.Z * v.Z;
        public Basis Inverse() => this;  // the tests' own is that of no turn
    }

    public struct Transform3D
    {
        public Basis Basis;
        public Vector3 Origin;
        public Transform3D(Basis basis, Vector3 origin) { Basis = basis; Origin = origin; }
        public Vector3 Of(Vector3 v) => Origin + Basis * v;
    }

    public class Mesh { }
    public class CylinderMesh : Mesh { public float TopRadius, BottomRadius, Height; }

    public class MultiMesh
    {
        public enum TransformFormatEnum { Transform2D, Transform3D }
        public TransformFormatEnum TransformFormat;
        public Mesh Mesh;
        public Transform3D[] Placed;
        public int InstanceCount { set { Placed = new Transform3D[value]; } }
        public void SetInstanceTransform(int i, Transform3D transform) { Placed[i] = transform; }
    }

    public class MultiMeshInstance3D
    {
        public MultiMesh Multimesh;
        public Transform3D GlobalTransform =
            new Transform3D(new Basis(new Quaternion(0, 0, 0, 1)), new Vector3());
        public virtual void _Ready() { }
        public virtual void _Process(double delta) { }
        public virtual void _ExitTree() { }
    }
}

static class Program
{
    static void Main(string[] arguments)
    {
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        Print(new Basis(TreeInGodot.Rotation(0.1, 0.7, -0.5, 0.5)) * TreeInGodot.Point(1, 2, 3));
        var tree = new TreeInGodot { File = arguments[0] + "/tree.sway" };
        tree.Wind = new Vector3(8, 0, -1);
        tree._Ready();
        for (int frame = 0; frame < 64; frame++) tree._Process(1.0 / 64);
        foreach (var wood in tree.Multimesh.Placed)
        {
            Print(wood.Of(new Vector3(0, -0.5f, 0)));
            Print(wood.Of(new Vector3(0, 0.5f, 0)));
            Print(wood.Of(new Vector3(0.5f, -0.5f, 0)));
        }
        tree._ExitTree();
    }

    static void Print(Vector3 v) => Console.WriteLine(v.X + " " + v.Y + " " + v.Z);
}
