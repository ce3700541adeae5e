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
    const int LargestMessage = 64 << 20, LargestHeader = 8 << 20, Head = 28, Part = 8, Silence = 6000;
    const int MostPoses = 10000000, MostCoordinates = 65535, MostMemory = 512 << 20;
    const double Greatest = 1e18;

    // Arrays of a kind of tree: name, type, axes. Those of f64 are laid out here, the others are
    // received; the core takes the first.
    const int OfCore = 18;
    static readonly string[] Forms =
    {
        "branch_first i32 b+1", "branch_parent i32 b", "branch_base_segment i32 b",
        "branch_coordinate i32 b", "branch_keys u8 b", "branch_frame f32 b 3 3",
        "branch_skew f32 b 2", "branch_offset f32 b 3", "segment_slope f32 n",
        "segment_tip_slope f32 n", "segment_chord f32 n 3", "segment_rest f32 n 4",
        "tree_start f64 n 3", "tree_end f64 n 3", "tree_base_diameter f64 n",
        "tree_tip_diameter f64 n", "branch_twist f64 b k 6", "segment_turn f64 n k 3",
        "branch_base_turn i32 b", "branch_turn i32 b", "turn f32 rows 3", "segment_length f32 n",
        "segment_radius f32 n 2", "basis_matrix f32 N m", "basis_scale f32 m",
    };

    // Entries of a header without spaces. In a text a quote has a backslash before it, so no entry
    // is found there.
    const string ArrayEntry = @"""([\w/]+)"":{(?=[^{}]*""offset"":([0-9]{1,8})[,}])"
        + @"(?=[^{}]*""shape"":\[([0-9,]+)\])(?=[^{}]*""type"":""(\w+)"")";
    const string TreeEntry = @"""kind"":([0-9]{1,8})[,}]";
    const string Identity = @"""identity"":""([0-9a-f]{8})[0-9a-f]{8}""";

    /// Pose i is Poses[7 i] to Poses[7 i + 6]: x y z of the root-side node [m], then x y z w.
    /// Another array after another description.
    public double[] Poses { get; private set; }
    /// Length and mean diameter of each segment [m].
    public double[] Lengths, Diameters;
    /// Number and time [ns] of the frame, and its flags: 1 paused, 2 beyond the scale, 4 the motion
    /// jumped, 16 the wind is lost.
    public uint Sequence;
    public long Stamp;
    public int Flags;

    readonly ClientWebSocket socket = new ClientWebSocket();
    readonly List<Kind> kinds = new List<Kind>();
    byte[] buffer = new byte[4096];
    IntPtr stand;
    Tree[] trees;
    uint identity;
    int coordinates, credit, awaited;

    /// Connect to a server, with the token of its page if it has one, for frames per second.
    public async Task Connect(string url, string token = "", int rate = 60)
    {
        if (token != "") socket.Options.SetRequestHeader("Authorization", "Bearer " + token);
        await socket.ConnectAsync(new Uri(url), CancellationToken.None);
        await Say("rate", rate);
    }

    /// Wait for a frame, and place all trees by it.
    public async Task Read()
    {
        bool isPlaced = false;
        for (int size = 0; !isPlaced;)
        {
            if (size == buffer.Length) Array.Resize(ref buffer, 2 * size);
            var room = new ArraySegment<byte>(buffer, size, buffer.Length - size);
            WebSocketReceiveResult part;
            using (var silence = new CancellationTokenSource(Silence))
                part = await socket.ReceiveAsync(room, silence.Token);
            Need(part.MessageType != WebSocketMessageType.Close, "end of the stream");
            size += part.Count;
            Need(size <= LargestMessage, "size of a message");
            if (!part.EndOfMessage) continue;
            bool isText = part.MessageType == WebSocketMessageType.Text;
            isPlaced = !isText && Take(buffer.Take(size).ToArray());
            size = 0;
            int more = credit - awaited;
            // Also after a text, which comes twice a second: a server does not keep a silent client.
            if (more < 4 && !isText) continue;
            awaited += more;
            await Say("credit", more);
        }
    }

    /// Take a description or a frame, however it came; true if there are new poses.
    public bool Take(byte[] message)
    {
        if (message.Length >= Head && message[0] == 0x46) return Place(message);
        Close();
        try
        {
            Describe(message);
        }
        catch (Exception error)
        {
            Close();
            throw new FormatException("description: " + error.Message, error);
        }
        return false;
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
        foreach (var kind in kinds.Where(kind => kind.Model != IntPtr.Zero)) sway_model_close(kind.Model);
        kinds.Clear();
        stand = IntPtr.Zero;
    }

    Task Say(string what, int value)
    {
        var text = Encoding.ASCII.GetBytes("{\"" + what + "\": " + value + "}");
        var all = new ArraySegment<byte>(text);
        return socket.SendAsync(all, WebSocketMessageType.Text, true, CancellationToken.None);
    }

    bool Place(byte[] data)
    {
        awaited--;
        int count = BitConverter.ToUInt16(data, 26), at = Head, end = Head + 2 * count;
        Need(data[1] == 1, "version of a frame");
        // Some of the coordinates, or none, are for receivers that solve the trees.
        if ((data[2] & Part) != 0) return false;
        Need(data.Length >= end && (data.Length - end) % 8 == 0, "length of a frame");
        if (stand == IntPtr.Zero || BitConverter.ToUInt32(data, 4) != identity) return false;
        if (count == 0 && coordinates > 0) return false;
        Need(count == coordinates, "number of coordinates of a frame");
        var turns = new float[(data.Length - end) / 4];
        Buffer.BlockCopy(data, end, turns, 0, 4 * turns.Length);
        Need(turns.All(turn => Math.Abs(turn) < Greatest), "rotation of a frame");
        Flags = data[2];
        Sequence = BitConverter.ToUInt32(data, 8);
        Stamp = BitConverter.ToInt64(data, 12);
        int key = 0, row = 0;
        for (int tree = 0; tree < trees.Length; tree++)
        {
            var kind = kinds[(int)trees[tree].Model];
            double[] basis = kind["basis_matrix"], scale = kind["basis_scale"];
            var keys = new double[kind.Sizes["N"]];
            for (int i = 0; i < scale.Length; i++, at += 2)
            {
                double value = BitConverter.ToInt16(data, at) / 32767.0 * scale[i];
                for (int k = 0; k < keys.Length; k++) keys[k] += basis[k * scale.Length + i] * value;
            }
            for (int i = 0; i < turns.Length; i += 2)
                if (turns[i] >= key && turns[i] < key + keys.Length) keys[(int)turns[i] - key] += turns[i + 1];
            sway_place_keys(stand, UIntPtr.Zero, (UIntPtr)tree, keys, ref Poses[7 * row]);
            key += keys.Length;
            row += kind.Sizes["n"];
        }
        return true;
    }

    void Describe(byte[] data)
    {
        Need(data.Length >= 12 && Encoding.ASCII.GetString(data, 0, 4) == "TSWD", "its beginning");
        Need(BitConverter.ToInt32(data, 4) == 2, "its version");
        int size = BitConverter.ToInt32(data, 8);
        Need(size >= 0 && size <= Math.Min(LargestHeader, data.Length - 12), "size of its header");
        var header = Regex.Replace(Encoding.UTF8.GetString(data, 12, size), @"\s", "");
        var own = Regex.Match(header, Identity);
        Need(own.Success, "identity");
        identity = Convert.ToUInt32(own.Groups[1].Value, 16);
        var entries = new Dictionary<string, Match>();
        foreach (Match entry in Regex.Matches(header, ArrayEntry)) entries[entry.Groups[1].Value] = entry;
        while (kinds.Count == 0 || entries.ContainsKey(kinds.Count + "/turn"))
        {
            var kind = new Kind();
            foreach (var form in Forms) kind.Receive(kinds.Count + "/", form, entries, data, 12 + size);
            kinds.Add(kind);
            kind.Open();
        }
        var places = new Kind();
        places.Receive("", "tree_place f32 t 5", entries, data, 12 + size);
        var place = places["tree_place"];
        var found = Regex.Matches(header, TreeEntry);
        Need(found.Count > 0 && found.Count == places.Sizes["t"], "trees");
        trees = new Tree[found.Count];
        coordinates = 0;
        List<double> lengths = new List<double>(), diameters = new List<double>();
        for (int i = 0; i < trees.Length; i++)
        {
            int number = int.Parse(found[i].Groups[1].Value), at = 5 * i;
            Need(number < kinds.Count, "kind of tree", i);
            trees[i] = new Tree { Model = number, X = place[at], Y = place[at + 1], Z = place[at + 2],
                Yaw = place[at + 3], Scale = place[at + 4], Speed = 1 };
            double[] length = kinds[number]["segment_length"], radius = kinds[number]["segment_radius"];
            for (int s = 0; s < length.Length; s++)
            {
                lengths.Add(place[at + 4] * length[s]);
                diameters.Add(place[at + 4] * (radius[2 * s] + radius[2 * s + 1]));
            }
            coordinates += kinds[number].Sizes["m"];
            Need(lengths.Count <= MostPoses && coordinates <= MostCoordinates, "number of trees");
        }
        var error = new byte[300];
        var models = kinds.Select(kind => kind.Model).ToArray();
        stand = sway_stand_open(models, (UIntPtr)models.Length, trees, (UIntPtr)trees.Length,
            (UIntPtr)1, error, (UIntPtr)error.Length);
        Need(stand != IntPtr.Zero, Encoding.UTF8.GetString(error));
        Lengths = lengths.ToArray();
        Diameters = diameters.ToArray();
        Poses = new double[7 * Lengths.Length];
        credit = Math.Max(8, Math.Min(24, 200000 / (Head + 2 * coordinates)));
    }

    static void Need(bool holds, string name, int row = -1)
    {
        if (holds) return;
        var where = row < 0 ? "" : "[" + row + "]";
        throw new FormatException(name.TrimEnd('\0') + where + " is not as doc/streaming.md has it");
    }

    // Trees of one shape: its arrays by name, the sizes of their axes, and its model in the core.
    sealed class Kind : Dictionary<string, double[]>
    {
        public readonly Dictionary<string, int> Sizes = new Dictionary<string, int>();
        public IntPtr Model;

        // Read an array; an axis has one size in all arrays of a kind.
        public void Receive(string prefix, string form, Dictionary<string, Match> entries, byte[] data,
            int begin)
        {
            string[] words = form.Split(' ');
            string name = words[0], type = words[1];
            if (type == "f64") return;
            Match entry;
            Need(entries.TryGetValue(prefix + name, out entry) && entry.Groups[4].Value == type, name);
            string[] shape = entry.Groups[3].Value.Split(',');
            Need(shape.Length == words.Length - 2, name);
            long count = 1, at = begin + int.Parse(entry.Groups[2].Value), width = type == "u8" ? 1 : 4;
            for (int axis = 0; axis < shape.Length; axis++)
            {
                int size, wanted;
                string of = words[2 + axis];
                Need(int.TryParse(shape[axis], out size), name);
                if (!int.TryParse(of, out wanted) && !Sizes.TryGetValue(of, out wanted)) Sizes[of] = wanted = size;
                Need(size == wanted && (count *= size) <= data.Length, name);
            }
            Need(at + count * width <= data.Length, name);
            var found = this[name] = new double[count];
            for (int i = 0; i < count; i++, at += width)
            {
                found[i] = type == "u8" ? data[at] : type == "i32" ? BitConverter.ToInt32(data, (int)at)
                    : BitConverter.ToSingle(data, (int)at);
                Need(Math.Abs(found[i]) < Greatest && (name != "basis_scale" || found[i] > 0), name, i);
            }
        }

        // Check the arrays, lay out what the core turns branches by, and give it their model.
        public void Open()
        {
            double[] first = this["branch_first"], parent = this["branch_parent"], turn = this["turn"];
            double[] keys = this["branch_keys"], slope = this["segment_slope"];
            double[] frame = this["branch_frame"];
            int b = Sizes["b"], n = Sizes["n"], rows = Sizes["rows"];
            Need(b > 0 && first.Length == b + 1 && first[0] == 0 && first[b] == n, "branch_first");
            Need(keys.Min() >= 2 && keys.Sum() == Sizes["N"], "branch_keys or basis_matrix");
            int room = Sizes["k"] = (int)keys.Max();
            Need(48L * room * n <= MostMemory, "size of a kind");
            var twist = this["branch_twist"] = new double[6 * room * b];
            var turns = this["segment_turn"] = new double[3 * room * n];
            for (int i = 0; i < b; i++)
            {
                int from = (int)first[i], to = (int)first[i + 1], own = (int)keys[i], up = (int)parent[i];
                int joint = (int)this["branch_base_turn"][i], bend = (int)this["branch_turn"][i];
                Need(from < to && to <= n, "branch_first", i);
                Need(up >= Math.Min(i - 1, 0) && up < i, "branch_parent", i);
                Need(i == 0 ? joint == -1 : joint >= 0 && joint <= rows - keys[up], "branch_base_turn", i);
                Need(bend < 0 ? bend == -1 && own == 2 : bend <= rows - (to - from) * own, "branch_turn", i);
                for (int k = 0; i > 0 && k < keys[up]; k++)
                    Array.Copy(turn, 3 * (joint + k), twist, 6 * (room * i + k) + 3, 3);
                for (int s = from; s < to; s++)
                {
                    int at = 3 * room * s;
                    if (bend >= 0) Array.Copy(turn, 3 * (bend + (s - from) * own), turns, at, 3 * own);
                    for (int c = 0; c < 3 && bend < 0; c++)
                    {
                        turns[at + c] = slope[s] * frame[9 * i + 6 + c];
                        turns[at + 3 + c] = -slope[s] * frame[9 * i + 3 + c];
                    }
                }
            }
            this["tree_start"] = this["tree_end"] = new double[3 * n];
            this["tree_base_diameter"] = this["tree_tip_diameter"] = new double[n];
            var error = new byte[300];
            var bytes = Bytes();
            Model = sway_model_open(bytes, (UIntPtr)bytes.Length, error, (UIntPtr)error.Length);
            Need(Model != IntPtr.Zero, Encoding.UTF8.GetString(error));
        }

        // The bytes of a .sway file (native/model.cpp): entries of 72 bytes, then the numbers.
        byte[] Bytes()
        {
            var bytes = new MemoryStream();
            var writer = new BinaryWriter(bytes);
            var forms = Forms.Take(OfCore).Select(form => form.Split(' ')).ToArray();
            long at = 16 + 72 * OfCore;
            writer.Write("SWAYTREE".ToCharArray());
            writer.Write(1);
            writer.Write(OfCore);
            foreach (var words in forms)
            {
                writer.Write(words[0].PadRight(24, '\0').ToCharArray());
                writer.Write(words[1][0] == 'f' ? 0 : 2);
                writer.Write(words.Length - 2);
                for (int axis = 2; axis < 6; axis++)
                {
                    int size = 0;
                    if (axis < words.Length && !Sizes.TryGetValue(words[axis], out size)) size = int.Parse(words[axis]);
                    writer.Write((long)size);
                }
                writer.Write(at);
                at += 8 * this[words[0]].Length;
            }
            foreach (var words in forms)
                foreach (double value in this[words[0]])
                    if (words[1][0] == 'f') writer.Write(value);
                    else writer.Write((long)value);
            return bytes.ToArray();
        }
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
