// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// What the example takes from UnityEngine, and a program that runs it. No engine is here.
using System;
using System.Collections.Generic;
using System.Globalization;
using UnityEngine;

namespace UnityEngine
{
    public struct Vector3
    {
        public float x, y, z;
        public Vector3(float x, float y, float z) { this.x = x; this.y = y; this.z = z; }
        public static Vector3 operator +(Vector3 a, Vector3 b) =>
            new Vector3(a.x + b.x, a.y + b.y, a.z + b.z);
    }

    public struct Quaternion
    {
        public float x, y, z, w;
        public Quaternion(float x, float y, float z, float w)
        {
            this.x = x; this.y = y; this.z = z; this.w = w;
        }
        public static Quaternion operator *(Quaternion a, Quaternion b) => new Quaternion(
            a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
            a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
            a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x,
            a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z);
        public static Vector3 operator *(Quaternion q, Vector3 v)
        {
            var turned = q * new Quaternion(v.x, v.y, v.z, 0)
                * new Quaternion(-q.x, -q.y, -q.z, q.w);
            return new Vector3(turned.x, turned.y, turned.z);
        }
    }

    public class Component { }
    public class Collider : Component { }
    public enum PrimitiveType { Cylinder }
    public static class Time { public static float deltaTime; }
    public static class Application { public static string streamingAssetsPath; }

    public class Transform : Component
    {
        public Vector3 localPosition, localScale;
        public Quaternion localRotation;
        public void SetParent(Transform parent, bool stays) { }
        public Vector3 InverseTransformDirection(Vector3 v) => v;
        public Vector3 Of(Vector3 v) => localPosition + localRotation * new Vector3(
            v.x * localScale.x, v.y * localScale.y, v.z * localScale.z);
    }

    public class GameObject
    {
        public static readonly List<Transform> Made = new List<Transform>();
        public Transform transform = new Transform();
        public T GetComponent<T>() where T : Component => null;
        public static GameObject CreatePrimitive(PrimitiveType kind)
        {
            var made = new GameObject();
            Made.Add(made.transform);
            return made;
        }
    }

    public class MonoBehaviour
    {
        public Transform transform = new Transform();
        protected static void Destroy(Component component) { }
    }
}

static class Program
{
    static void Main(string[] arguments)
    {
        CultureInfo.DefaultThreadCurrentCulture = CultureInfo.InvariantCulture;
        CultureInfo.CurrentCulture = CultureInfo.InvariantCulture;
        Print(TreeInUnity.Rotation(0.1, 0.7, -0.5, 0.5) * TreeInUnity.Point(1, 2, 3));
        Application.streamingAssetsPath = arguments[0];
        Time.deltaTime = 1f / 64;
        var tree = new TreeInUnity { file = "tree.sway", wind = new Vector3(8, 0, 1) };
        Call(tree, "Start");
        for (int frame = 0; frame < 64; frame++) Call(tree, "Update");
        foreach (var wood in GameObject.Made)
        {
            Print(wood.Of(new Vector3(0, -1, 0)));
            Print(wood.Of(new Vector3(0, 1, 0)));
            Print(wood.Of(new Vector3(0.5f, -1, 0)));
        }
        Call(tree, "OnDestroy");
    }

    static void Call(object tree, string name) => tree.GetType().GetMethod(name,
        System.Reflection.BindingFlags.NonPublic | System.Reflection.BindingFlags.Instance)
        .Invoke(tree, null);

    static void Print(Vector3 v) => Console.WriteLine(v.x + " " + v.y + " " + v.z);
}
