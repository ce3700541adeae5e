// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Prints each of some frames of a server: number, time, flags, poses. Without a number of frames it
// takes the messages of files, and prints of each whether it gives poses, or why it is refused.
using System;
using System.Globalization;
using System.IO;
using System.Linq;

static class Program
{
    static void Main(string[] arguments)
    {
        using (var stream = new SwayStream())
        {
            int count;
            if (arguments.Length == 2 && int.TryParse(arguments[1], out count))
            {
                stream.Connect(arguments[0]).Wait();
                for (int i = 0; i < count; i++)
                {
                    stream.Read().Wait();
                    var poses = stream.Poses.Select(n => n.ToString("R", CultureInfo.InvariantCulture));
                    Console.WriteLine(stream.Sequence + " " + stream.Stamp + " " + stream.Flags + " "
                        + string.Join(" ", poses));
                }
                return;
            }
            foreach (var file in Directory.GetFiles(arguments[0]).OrderBy(n => n, StringComparer.Ordinal))
            {
                string answer;
                try
                {
                    answer = stream.Take(File.ReadAllBytes(file)).ToString();
                }
                catch (FormatException error)
                {
                    answer = error.Message.Replace('\n', ' ');
                }
                Console.WriteLine(Path.GetFileName(file) + " " + answer);
            }
        }
    }
}
