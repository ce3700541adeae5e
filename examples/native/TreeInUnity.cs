// Copyright 2026 Tree Sway maintainers
// SPDX-License-Identifier: Apache-2.0
//
// Unity: x east, y up, z north, left-handed. A cylinder for each segment, below this object.
using System.IO;
using UnityEngine;

public class TreeInUnity : MonoBehaviour
{
    public string file = "oak.sway";  // in Assets/StreamingAssets
    public Vector3 wind = new Vector3(5, 0, 0);  // where the air goes, in the world [m/s]
    // A cylinder stands on y, a segment lies on x.
    static readonly Quaternion Lying = new Quaternion(0, 0, -0.70710678f, 0.70710678f);
    SwayTree tree;
    Transform[] wood;

    public static Vector3 Point(double x, double y, double z) =>
        new Vector3((float)x, (float)z, (float)y);

    public static Quaternion Rotation(double x, double y, double z, double w) =>
        new Quaternion((float)-x, (float)-z, (float)-y, (float)w);

    void Start()
    {
        var path = Path.Combine(Application.streamingAssetsPath, file);
        tree = new SwayTree(File.ReadAllBytes(path));
        wood = new Transform[tree.Lengths.Length];
        for (int i = 0; i < wood.Length; i++)
        {
            var cylinder = GameObject.CreatePrimitive(PrimitiveType.Cylinder);
            Destroy(cylinder.GetComponent<Collider>());
            wood[i] = cylinder.transform;
            wood[i].SetParent(transform, false);
            var thick = (float)tree.Diameters[i];  // it is 2 high and 1 thick
            wood[i].localScale = new Vector3(thick, 0.5f * (float)tree.Lengths[i], thick);
        }
    }

    void Update()
    {
        if (tree == null) return;
        var air = transform.InverseTransformDirection(wind);
        tree.Step(air.x, air.z, air.y, Time.deltaTime);
        var p = tree.Poses;
        for (int i = 0, k = 0; i < wood.Length; i++, k += 7)
        {
            var turn = Rotation(p[k + 3], p[k + 4], p[k + 5], p[k + 6]);
            var half = turn * new Vector3(0.5f * (float)tree.Lengths[i], 0, 0);
            wood[i].localPosition = Point(p[k], p[k + 1], p[k + 2]) + half;
            wood[i].localRotation = turn * Lying;
        }
    }

    void OnDestroy() => tree?.Dispose();
}
