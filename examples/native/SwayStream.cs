// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Trees of `tree-sway show` or the node `viewer` in C#: messages of doc/streaming.md in, poses out,
// in the axes of sway.h. For Unity, Godot and plain .NET, as SwayTree.cs, and on one thread:
//
//     var stream = new SwayStream();
//     await stream.Connect("ws://127.0.0.1:8765/stream");
//     while (true)
//     {
//         await stream.Read();
//         Draw(stream.Poses);
//     }
//
// A message that is not sound is a FormatException that names what is wrong, and a line that ends
// is an exception too: dispose of the stream then, and make another.
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Net.WebSockets;
using System.Runtime.InteropServices;
using System.Text;
using System.Text.RegularExpressions;
using System.Threading;
using System.Threading.Tasks;

public sealed class SwayStream : IDisposable
{
    const string Library = "sway";  // libsway.so, libsway.dylib, sway.dll; "__Internal" on iOS
    const CallingConvention C = CallingConvention.Cdecl;
    const int Largest = 64 << 20, LargestHeader = 8 << 20, MostMemory = 512 << 20;
    const int MostPoses = 10000000, MostCoordinates = 65535, Head = 28, Part = 8, Silence = 6000;
    const double Greatest = 1e18;

    // Arrays of a kind that the core takes; the last six are made here.
    const string OfCore = "branch_first branch_parent branch_base_segment branch_coordinate "
        + "branch_keys branch_frame branch_skew branch_offset segment_slope segment_tip_slope "
        + "segment_chord segment_rest branch_twist segment_turn tree_start tree_end "
        + "tree_base_diameter tree_tip_diameter";

    // Entries of a header without spaces, with ' for each quote. In a text a quote has a backslash
    // before it, so none is found there.
    const string ArrayEntry = "'([\\w/]+)':{(?=[^{}]*'offset':([0-9]{1,8})[,}])"
        + "(?=[^{}]*'shape':\\[([0-9,]+)\\])(?=[^{}]*'type':'(f32|i32|u8)')";
    const string TreeEntry = "'kind':([0-9]{1,8})[,}]";
    const string Identity = "'identity':'([0-9a-f]{8})[0-9a-f]{8}'";

    /// Pose i is Poses[7 i] to Poses[7 i + 6]: x y z of the root-side node [m], then x y z w.
    /// After another description this and the next two are other arrays.
    public double[] Poses;
    /// Length and mean diameter of each segment [m].
    public double[] Lengths, Diameters;
    /// Number and time [ns] of the frame, and its flags: 1 paused, 2 beyond the scale, 4 the motion
    /// jumped, 16 the wind is lost.
    public uint Sequence;
    public long Stamp;
    public int Flags;

    readonly ClientWebSocket socket = new ClientWebSocket();
    readonly List<Kind> kinds = new List<Kind>();
    readonly Dictionary<string, Numbers> arrays = new Dictionary<string, Numbers>();
    byte[] buffer = new byte[4096];
    string part;  // what is read, for errors
    IntPtr stand;
    Tree[] trees;
    uint identity;
    int coordinates, credit, awaited;

    class Numbers { public bool IsWhole; public long[] Shape; public double[] Values; }

    // Trees of one shape.
    class Kind
    {
        public double[] Basis, Scale, Lengths, Radii;
        public int Keys;
        public IntPtr Model;
    }

    /// Connect to a server, with the token of its page if it has one, for `rate` frames a second.
    public async Task Connect(string url, string token = "", int rate = 60)
    {
        if (token != "") socket.Options.SetRequestHeader("Authorization", "Bearer " + token);
        await socket.ConnectAsync(new Uri(url), CancellationToken.None);
        await Say("{'rate': " + rate + "}");
    }

    /// Wait for a frame, and place all trees by it.
    public async Task Read()
    {
        bool isPlaced = false;
        for (int size = 0; !isPlaced;)
        {
            if (size == buffer.Length) Array.Resize(ref buffer, 2 * size);
            var room = new ArraySegment<byte>(buffer, size, buffer.Length - size);
            WebSocketReceiveResult got;
            using (var silence = new CancellationTokenSource(Silence))
                got = await socket.ReceiveAsync(room, silence.Token);
            size += got.Count;
            bool isText = got.MessageType == WebSocketMessageType.Text;
            if (got.CloseStatus != null || size > Largest)
                throw new WebSocketException("end of the stream");
            if (!got.EndOfMessage) continue;
            isPlaced = !isText && Take(new MemoryStream(buffer, 0, size).ToArray());
            size = 0;
            int more = credit - awaited;
            // Also after a text, which comes twice a second: a server leaves a silent client.
            if (more < 4 && !isText) continue;
            awaited += more;
            await Say("{'credit': " + more + "}");
        }
    }

    /// Take a description or a frame, however it came; true if there are new poses.
    public bool Take(byte[] message)
    {
        try
        {
            if (message.Length >= Head && message[0] == 0x46) return Place(message);
            Describe(message);
            return false;
        }
        catch (Exception error)
        {
            Close();
            throw new FormatException(part + ": " + error.Message, error);
        }
    }

    public void Dispose()
    {
        socket.Dispose();
        Close();
        GC.SuppressFinalize(this);
    }

    ~SwayStream() => Close();

    void Close()
    {
        if (stand != IntPtr.Zero) sway_stand_close(stand);
        kinds.ForEach(kind => sway_model_close(kind.Model));
        kinds.Clear();
        arrays.Clear();
        stand = IntPtr.Zero;
    }

    Task Say(string text)
    {
        var bytes = new ArraySegment<byte>(Encoding.ASCII.GetBytes(text.Replace('\'', '"')));
        return socket.SendAsync(bytes, WebSocketMessageType.Text, true, CancellationToken.None);
    }

    void Need(bool holds, string name)
    {
        part = name;
        if (!holds) throw new FormatException("not as doc/streaming.md has it");
    }

    bool Place(byte[] data)
    {
        awaited--;
        int count = BitConverter.ToUInt16(data, 26), at = Head, end = Head + 2 * count;
        int row = 0, key = 0;
        Need(data[1] == 1, "version of a frame");
        // Some of the coordinates, or none, are for receivers that solve the trees.
        if ((data[2] & Part) != 0 || count < Math.Min(1, coordinates)) return false;
        if (stand == IntPtr.Zero || BitConverter.ToUInt32(data, 4) != identity) return false;
        Need(count == coordinates && (data.Length - end) % 8 == 0, "length of a frame");
        var turns = new float[(data.Length - end) / 4];
        Buffer.BlockCopy(data, end, turns, 0, 4 * turns.Length);
        Need(turns.All(turn => Math.Abs(turn) < Greatest), "rotation of a frame");
        Flags = data[2];
        Sequence = BitConverter.ToUInt32(data, 8);
        Stamp = BitConverter.ToInt64(data, 12);
        for (int tree = 0; tree < trees.Length; tree++)
        {
            var kind = kinds[(int)trees[tree].Model];
            var keys = new double[kind.Keys];
            int m = kind.Scale.Length;
            for (int i = 0; i < m; i++, at += 2)
            {
                double value = BitConverter.ToInt16(data, at) / 32767.0 * kind.Scale[i];
                for (int k = 0; k < keys.Length; k++) keys[k] += kind.Basis[k * m + i] * value;
            }
            for (int i = 0; i < turns.Length; i += 2)
                if (turns[i] >= key && turns[i] < key + keys.Length)
                    keys[(int)turns[i] - key] += turns[i + 1];
            sway_place_keys(stand, UIntPtr.Zero, (UIntPtr)tree, keys, ref Poses[7 * row]);
            key += keys.Length;
            row += kind.Lengths.Length;
        }
        return true;
    }

    void Describe(byte[] data)
    {
        Close();
        bool isOne = data.Length >= 12 && Encoding.ASCII.GetString(data, 0, 4) == "TSWD";
        Need(isOne, "beginning of a description");
        Need(BitConverter.ToInt32(data, 4) == 2, "version of a description");
        int size = BitConverter.ToInt32(data, 8);
        Need(size >= 0 && size <= Math.Min(LargestHeader, data.Length - 12), "size of a header");
        var header = Regex.Replace(Encoding.UTF8.GetString(data, 12, size), "[\\s']", "");
        header = header.Replace('"', '\'');
        part = "identity";
        identity = Convert.ToUInt32(Regex.Match(header, Identity).Groups[1].Value, 16);
        foreach (Match entry in Regex.Matches(header, ArrayEntry)) Decode(entry.Groups, data, 12 + size);
        while (kinds.Count == 0 || arrays.ContainsKey(kinds.Count + "/turn")) Open(kinds.Count + "/");
        var found = Regex.Matches(header, TreeEntry);
        var place = Of("tree_place", found.Count, 5);
        trees = new Tree[found.Count];
        coordinates = 0;
        List<double> lengths = new List<double>(), diameters = new List<double>();
        for (int i = 0, at = 0; i < trees.Length; i++, at += 5)
        {
            part = "kind of tree " + i;
            int number = int.Parse(found[i].Groups[1].Value);
            trees[i] = new Tree { Model = number, X = place[at], Y = place[at + 1], Z = place[at + 2],
                Yaw = place[at + 3], Scale = place[at + 4], Speed = 1 };
            var kind = kinds[number];
            for (int s = 0; s < kind.Lengths.Length; s++)
            {
                lengths.Add(trees[i].Scale * kind.Lengths[s]);
                diameters.Add(trees[i].Scale * (kind.Radii[2 * s] + kind.Radii[2 * s + 1]));
            }
            coordinates += kind.Scale.Length;
            Need(lengths.Count <= MostPoses && coordinates <= MostCoordinates, "number of trees");
        }
        var models = kinds.Select(kind => kind.Model).ToArray();
        stand = sway_stand_open(models, (UIntPtr)models.Length, trees, (UIntPtr)trees.Length,
            (UIntPtr)1, null, UIntPtr.Zero);
        Need(stand != IntPtr.Zero && trees.Length > 0, "tree_place");
        Lengths = lengths.ToArray();
        Diameters = diameters.ToArray();
        Poses = new double[7 * Lengths.Length];
        arrays.Clear();
        credit = Math.Max(8, Math.Min(24, 200000 / (Head + 2 * coordinates)));
    }

    // Read the array of an entry of the header.
    void Decode(GroupCollection entry, byte[] data, int begin)
    {
        string type = entry[4].Value;
        part = entry[1].Value;
        var shape = entry[3].Value.Split(',').Select(long.Parse).ToArray();
        int at = begin + int.Parse(entry[2].Value), width = type == "u8" ? 1 : 4;
        long count = shape.Aggregate(1L, (product, axis) => checked(product * axis));
        Need(count <= (data.Length - at) / width, part);
        var values = new double[count];
        for (int i = 0; i < count; i++, at += width)
            values[i] = type == "u8" ? data[at] : type == "i32" ? BitConverter.ToInt32(data, at)
                : BitConverter.ToSingle(data, at);
        Need(values.All(value => Math.Abs(value) < Greatest), part);
        Set(part, type != "f32", values, shape);
    }

    void Set(string name, bool isWhole, double[] values, params long[] shape)
    {
        arrays[name] = new Numbers { IsWhole = isWhole, Shape = shape, Values = values };
    }

    // Values of an array, of a shape if one is given.
    double[] Of(string name, params long[] shape)
    {
        part = name;
        var found = arrays[name];
        Need(shape.Length == 0 || found.Shape.SequenceEqual(shape), name);
        return found.Values;
    }

    // Lay out by what branches turn, and open the model of a kind.
    void Open(string own)
    {
        double[] first = Of(own + "branch_first"), parent = Of(own + "branch_parent");
        double[] slope = Of(own + "segment_slope"), frame = Of(own + "branch_frame");
        double[] scale = Of(own + "basis_scale"), keys = Of(own + "branch_keys");
        long b = parent.Length, n = slope.Length;
        Need(keys.Length == b && keys.All(key => key >= 2), part);
        long room = (long)keys.Max();
        double[] turn = Of(own + "turn"), joints = Of(own + "branch_base_turn", b);
        Of(own + "turn", turn.Length / 3, 3);
        var bends = Of(own + "branch_turn", b);
        var kind = new Kind { Keys = (int)keys.Sum(), Lengths = Of(own + "segment_length", n),
            Radii = Of(own + "segment_radius", n, 2), Scale = Of(own + "basis_scale", scale.Length) };
        Need(scale.All(value => value > 0), part);
        kind.Basis = Of(own + "basis_matrix", kind.Keys, scale.Length);
        Need(48 * room * n <= MostMemory, "size of a kind");
        Need(first.Length == b + 1, own + "branch_first");
        double[] twist = new double[6 * room * b], turns = new double[3 * room * n];
        for (int i = 0; i < b; i++)
        {
            long from = (long)first[i], to = (long)first[i + 1];
            long count = (long)keys[i], bend = (long)bends[i];
            Need(0 <= from && from < to && to <= n, "branch_first of branch " + i);
            Need(bend >= 0 || bend == -1 && count == 2, "branch_turn of branch " + i);
            part = "branch_parent, branch_base_turn or branch_turn of branch " + i;
            for (int k = 0; i > 0 && k < keys[(int)parent[i]]; k++)
                Array.Copy(turn, 3 * ((long)joints[i] + k), twist, 6 * (room * i + k) + 3, 3);
            for (long s = from, at = 3 * room * s; s < to; s++, at += 3 * room)
            {
                long row = bend + (s - from) * count;
                if (bend >= 0) Array.Copy(turn, 3 * row, turns, at, 3 * count);
                for (int c = 0; c < 3 && bend < 0; c++)
                {
                    turns[at + c] = slope[s] * frame[9 * i + 6 + c];
                    turns[at + 3 + c] = -slope[s] * frame[9 * i + 3 + c];
                }
            }
        }
        Set(own + "branch_twist", false, twist, b, room, 6);
        Set(own + "segment_turn", false, turns, n, room, 3);
        // Not of use for poses.
        foreach (var name in new[] { "tree_start", "tree_end" })
            Set(own + name, false, new double[3 * n], n, 3);
        foreach (var name in new[] { "tree_base_diameter", "tree_tip_diameter" })
            Set(own + name, false, new double[n], n);
        var error = new byte[300];
        var model = ModelOf(own);
        kind.Model = sway_model_open(model, (UIntPtr)model.Length, error, (UIntPtr)error.Length);
        Need(kind.Model != IntPtr.Zero, Encoding.UTF8.GetString(error).TrimEnd('\0'));
        kinds.Add(kind);
    }

    // Bytes of a .sway file (native/model.cpp), which the core checks: entries, then numbers.
    byte[] ModelOf(string own)
    {
        MemoryStream entries = new MemoryStream(), numbers = new MemoryStream();
        BinaryWriter head = new BinaryWriter(entries), body = new BinaryWriter(numbers);
        var names = OfCore.Split(' ');
        head.Write("SWAYTREE".ToCharArray());
        head.Write(1);
        head.Write(names.Length);
        foreach (var name in names)
        {
            var given = arrays[part = own + name];
            head.Write(name.PadRight(24, '\0').ToCharArray());
            head.Write(given.IsWhole ? 2 : 0);
            head.Write(given.Shape.Length);
            for (int axis = 0; axis < 4; axis++) head.Write(given.Shape.ElementAtOrDefault(axis));
            head.Write(16 + 72 * names.Length + numbers.Length);
            foreach (double value in given.Values)
                if (given.IsWhole) body.Write((long)value);
                else body.Write(value);
        }
        numbers.WriteTo(entries);
        return entries.ToArray();
    }

    [StructLayout(LayoutKind.Sequential)]
    struct Tree { public long Model; public double X, Y, Z, Yaw, Scale, Speed; }

    [DllImport(Library, CallingConvention = C)]
    static extern IntPtr sway_model_open(byte[] bytes, UIntPtr size, byte[] error, UIntPtr room);
    [DllImport(Library, CallingConvention = C)]
    static extern void sway_model_close(IntPtr model);
    [DllImport(Library, CallingConvention = C)]
    static extern IntPtr sway_stand_open(IntPtr[] models, UIntPtr modelCount, Tree[] trees,
        UIntPtr treeCount, UIntPtr rooms, byte[] error, UIntPtr room);
    [DllImport(Library, CallingConvention = C)]
    static extern void sway_stand_close(IntPtr stand);
    [DllImport(Library, CallingConvention = C)]
    static extern void sway_place_keys(IntPtr stand, UIntPtr room, UIntPtr tree, double[] keys,
        ref double poses);
}
