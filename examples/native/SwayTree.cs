// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// A tree that sways in C#: a .sway file and wind in, poses out, in the axes of sway.h.
// For Unity, Godot and plain .NET; nothing here needs a compiler at run time (IL2CPP, AOT).
using System;
using System.Runtime.InteropServices;
using System.Text;

public sealed class SwayTree : IDisposable
{
    const string Library = "sway";  // libsway.so, libsway.dylib, sway.dll; "__Internal" on iOS
    const CallingConvention C = CallingConvention.Cdecl;
    static readonly long[] Rows = { 0, 0 };
    IntPtr model, stand;
    readonly double[] wind = new double[3];

    /// Pose i is Poses[7 i] to Poses[7 i + 6]: x y z of the root-side node [m], then x y z w.
    public readonly double[] Poses;
    /// Length and mean diameter of each segment [m].
    public readonly double[] Lengths, Diameters;

    public SwayTree(byte[] file)
    {
        var error = new byte[300];
        var room = (UIntPtr)error.Length;
        model = sway_model_open(file, (UIntPtr)file.Length, error, room);
        var sizes = new Sizes();
        if (model != IntPtr.Zero)
        {
            sway_model_sizes(model, ref sizes);
            var tree = new Tree { Scale = 1, Speed = 1 };
            var one = (UIntPtr)1;
            stand = sway_stand_open(new[] { model }, one, ref tree, one, one, error, room);
        }
        if (stand == IntPtr.Zero || sizes.IsStepped == 0)
        {
            Dispose();
            var why = Encoding.UTF8.GetString(error).TrimEnd('\0');
            throw new FormatException(why == "" ? "this tree can only be placed" : why);
        }
        var n = (int)sizes.Segments;
        Poses = new double[7 * n];
        sway_place(stand, UIntPtr.Zero, Rows, (UIntPtr)1, Poses);
        var start = Numbers(file, "tree_start", 3 * n);
        var end = Numbers(file, "tree_end", 3 * n);
        Lengths = new double[n];
        for (int i = 0; i < n; i++)
        {
            double x = end[3 * i] - start[3 * i], y = end[3 * i + 1] - start[3 * i + 1];
            double z = end[3 * i + 2] - start[3 * i + 2];
            Lengths[i] = Math.Sqrt(x * x + y * y + z * z);
        }
        Diameters = Numbers(file, "tree_base_diameter", n);
        var tip = Numbers(file, "tree_tip_diameter", n);
        for (int i = 0; i < n; i++) Diameters[i] = 0.5 * (Diameters[i] + tip[i]);
    }

    /// Go on by dt [s] in a wind [m/s], east, north, up; nothing moves unless dt is above 0.
    public void Step(double east, double north, double up, double dt)
    {
        if (stand == IntPtr.Zero || sway_set_step(stand, dt) != 0) return;
        wind[0] = east;
        wind[1] = north;
        wind[2] = up;
        sway_step(stand, UIntPtr.Zero, UIntPtr.Zero, (UIntPtr)1, wind, IntPtr.Zero);
        sway_place(stand, UIntPtr.Zero, Rows, (UIntPtr)1, Poses);
    }

    public void Dispose()
    {
        if (stand != IntPtr.Zero) sway_stand_close(stand);
        if (model != IntPtr.Zero) sway_model_close(model);
        stand = model = IntPtr.Zero;
        GC.SuppressFinalize(this);
    }

    ~SwayTree() => Dispose();

    // Numbers of a file that has been checked: entries of 72 bytes begin with a name and end with
    // the place of the numbers.
    static double[] Numbers(byte[] file, string name, int count)
    {
        int entry = 16;
        while (Encoding.ASCII.GetString(file, entry, 24).TrimEnd('\0') != name) entry += 72;
        var found = new double[count];
        Buffer.BlockCopy(file, (int)BitConverter.ToInt64(file, entry + 64), found, 0, 8 * count);
        return found;
    }

    [StructLayout(LayoutKind.Sequential)]
    struct Sizes { public long Segments, Branches, Keys, Coordinates, Delays, IsStepped; }

    [StructLayout(LayoutKind.Sequential)]
    struct Tree { public long Model; public double X, Y, Z, Yaw, Scale, Speed; }

    [DllImport(Library, CallingConvention = C)]
    static extern IntPtr sway_model_open(byte[] bytes, UIntPtr size, byte[] error, UIntPtr room);
    [DllImport(Library, CallingConvention = C)]
    static extern void sway_model_close(IntPtr model);
    [DllImport(Library, CallingConvention = C)]
    static extern void sway_model_sizes(IntPtr model, ref Sizes sizes);
    [DllImport(Library, CallingConvention = C)]
    static extern IntPtr sway_stand_open(IntPtr[] models, UIntPtr modelCount, ref Tree trees,
        UIntPtr treeCount, UIntPtr rooms, byte[] error, UIntPtr room);
    [DllImport(Library, CallingConvention = C)]
    static extern void sway_stand_close(IntPtr stand);
    [DllImport(Library, CallingConvention = C)]
    static extern int sway_set_step(IntPtr stand, double dt);
    [DllImport(Library, CallingConvention = C)]
    static extern int sway_step(IntPtr stand, UIntPtr room, UIntPtr first, UIntPtr count,
        double[] winds, IntPtr counts);
    [DllImport(Library, CallingConvention = C)]
    static extern void sway_place(IntPtr stand, UIntPtr room, long[] rows, UIntPtr count,
        double[] poses);
}
